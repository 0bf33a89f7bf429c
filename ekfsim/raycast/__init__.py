"""Which wall a beam meets first, and how far away it is. Nothing here knows what a robot is.

    rules.py     what it means that a beam meets a wall: corners, along it, from inside, ties
    brute.py     brute force: every beam tries every wall by these rules; the text of this room
    round_walls.py   circles, beside the straight walls
    walls.py     the walls of a map, and the one door to all that follows beams: `Walls.cast`
    ground.py    where a robot can stand among the walls
    searches/    the same answers with fewer trials: single beam, scan, many beams, grid

`Walls.cast` is brute force as it stands. What answers in its place, and when, is told in
searches/__init__.py; all of it gives the ranges of brute force, and the same walls.
"""
