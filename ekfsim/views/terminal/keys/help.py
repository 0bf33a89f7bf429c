"""What is told of the keys, in play as in its --help."""

HELP = """\
n  space  Enter  right  down  PageDown   next view; 12n: twelve of them
p  Backspace  left  up  PageUp           previous view; 12p: twelve back
13g  to step 13     g  r  Home  to the start     G  End  to the end
a  to the next ambiguous beam            l  to where the filter was lost
+  -  go on by itself, faster or slower; space waits, + goes on again
e  the narrative in its long form: every equation; e again for the short one
v  Tab  picture, numbers, or both        j  k  scroll the numbers
w  why it was lost, and what cures it    d  drive the robot on from here
s  save the picture       ?  h  F1  this help       q  Ctrl-D  quit
A step is one command; a reading has two views: the beam, then its outcome."""
