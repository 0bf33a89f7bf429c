"""A run over its steps: errors with their σ, NIS and NEES with their bounds, and what happened.

series.py    the numbers of one filter's run, gathered one step at a time
events.py    what happens at a step that its curves alone do not tell
thinning.py  the rows that a long run is drawn by, with all its peaks
"""
