"""What a notebook shows: tables, and what its cells make of scenes, steps, views and studies.

playing.py    the same steps as inside the program, which nobody can write into
showing.py    what a cell shows of a scene, a step, a view, a summary
drawing.py    a view on Axes of one's own, and more runs over it
table.py      steps → the columns of `run --csv`
animation.py  a run as it plays in a cell
studies.py    study and compare of a scene that a notebook holds
reasons.py    why the run of a scene was lost
cells.py      words and pictures → what a cell shows
"""
