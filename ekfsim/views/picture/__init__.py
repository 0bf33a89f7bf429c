"""What is drawn of a run with matplotlib: artists that are made once and moved, axes, frames.

frames.py    a figure with all that is on it, and its pixels, view by view
layout.py    where everything stands on a figure of any size
scope.py     how much of the plane each view shows      reach.py    how far a run reaches
limits.py    a rectangle of the plane                   panels.py   the map and the close-up
legend.py    what is seen in a view, named              samples.py  what stands for it there
names.py     of obstacles and landmarks                 crossed.py  where lines run, for the names
artists.py   what is drawn is made of; the world        belief/     estimate, ellipse, cone, ways
sights.py    of a reading, in numbers                   sight_artists.py  the same, drawn
outlined.py  text that changes, drawn fast              lettering.py      any text, made fit
replay.py    artists drawn again, fast                  look.py           what may be asked for
"""
