"""A run at the keyboard: keys in, text and pictures out, in a terminal or a window.

keys/         bytes → names of keys → what each asks for
player.py     steps through a run as keys are pressed: what is to be seen after each, a Moment
screens/      where a Moment is seen: in place, as a stream, in a window, in a file
images/       the picture as an image, where the terminal draws them
watching.py   files that are read again when they are saved
pace.py       a run that goes on by itself
drawing.py    a view in text, with readings.py and beliefs.py, on the canvas of braille.py
wrapping.py   lines of text
reason.py     why the run was lost, calculated when it is asked
driving/      a run that is driven by keys
stage.py      the screens that there are, and their keys
interactive.py  puts all of it together, to play or to drive
"""
