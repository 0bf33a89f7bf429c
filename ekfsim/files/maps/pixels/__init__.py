"""Pictures whose pixels are the cells of a map → straight walls.

image.py     a picture → grey           cells.py   grey → occupied, free, unknown
rooms.py     cells → the plan of a room   tracing.py  cells → outlines along their edges
straight.py  outlines of steps → straight walls
"""
