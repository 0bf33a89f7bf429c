"""What is told of the keys, in drive as in its --help."""

HELP = """\
up  f     down  x     forward, backward by the move; 1.5 and up: 1.5 m
left  <   right  >    turn left, right by the turn; 90 and left: by 90°
90b  -45b  b          beam at 90°, at -45°; where the last one went
[  ]   {  }           halve, double the move; the turn. 0.1] a move of 0.1 m
u  3u     U  Ctrl-R   undo a command, three of them; do them again
w                     write the commands file
n  p  13g  G          look back: next view, previous, to step 13, to the last
d                     go on from the view on show: undo what comes after it
a  l  e  v  j  k  s   as in play: ambiguous, lost, long form, panes, ...
?  h  F1              this help
q  Ctrl-D             quit; asked once where something is not written
Every key that drives is a command of the file, which plays the same run."""
