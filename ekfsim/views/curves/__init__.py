"""A run over its steps: errors with their σ, NIS and NEES with their bounds, and what happened.

series.py    the numbers of one filter's run, gathered one step at a time
events.py    what happens at a step that its curves alone do not tell
thinning.py  the rows that a long run is drawn by, with all its peaks
pens.py      how each filter's lines are drawn
bands.py     panels of errors and of innovations, with ±2σ; of what was learnt of a noise
judged.py    panels of NIS and NEES, with the bounds of χ²
marks.py     events, readings that were not used, where a filter was lost
panels.py    which panels a run has, and their axis of steps
strip.py     the panels small beneath a picture, with a cursor
plot.py      all of it on one figure, with the verdicts, as a file
errors.py    the same in a notebook: `ekfsim.plot_errors`
"""
