"""What is looked at in a submission, a file for each kind of part.

steps.py      each step beside the reference
jacobians.py  the student's own derivatives beside numerical ones
honesty.py    many runs: whether the filter is as sure as it may be
inputs.py     the student's own commands files
pupil.py      who calls the student's code

Each takes what is asked and a score that is not run, and gives it back with points and words.
"""
