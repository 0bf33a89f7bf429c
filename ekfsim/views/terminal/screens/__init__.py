"""Where an interactive run is seen.

moment.py   what is to be seen after a key, and what a screen is asked to do with it
console.py  a terminal, redrawn in place, as layout.py divides it
stream.py   a pipe, a file, a terminal that cannot do more: one below the other
window.py   a window with the picture    files.py  a picture in a file, and those that are saved
"""
