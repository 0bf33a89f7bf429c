"""What a notebook shows: tables, and what its cells make of scenes, steps, views and studies.

table.py    steps → the columns of `run --csv`
drawing.py  a view on Axes of one's own, and more runs over it
studies.py  study and compare of a scene that a notebook holds
cells.py    words and pictures → what a cell shows
"""
