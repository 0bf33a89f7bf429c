"""What is drawn of a run with matplotlib: artists that are made once and moved, axes, frames.

frames.py    a figure with all that is on it, and its pixels, view by view
layout.py    where everything stands on a figure of any size
panels.py    the map and the close-up           look.py             what may be asked for
artists.py   what is drawn is made of; the world
sights.py    of a reading, in numbers           sight_artists.py    the same, drawn
replay.py    artists drawn again, fast
belief/      estimate, ellipse, cone, ways      extent/    how much of the plane is seen
written/     legend, names, any text
"""
