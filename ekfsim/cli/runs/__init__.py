"""Commands of one run.

playing.py     play
driving.py     drive
drawing.py     render, plot
narrating.py   run
recording.py   record
explaining.py  why
"""
