"""A run as it is stepped through: what is on the screen after so many presses of `n`.

view.py      one view: a step, the way up to it, and how it is judged
zoom.py      how much a close-up shows, from step to step
trail.py     the ways: of the estimate, of the truth, of odometry alone
playback.py  the views of a run, one after another or by number
given.py     steps, from whoever calls the package
kept.py      steps, handed on to all who want them
length.py    how many there are
parting.py   from which step on several filters differ
"""
