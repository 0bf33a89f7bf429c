"""What is said of a beam to a wall.

beam.py  as it is drawn: where it ends, and where else it might have ended
hypotheses.py  which wall each of several hypotheses took it to meet
told.py  as it is narrated: the wall that it was expected to meet, and what is doubtful about that
"""
