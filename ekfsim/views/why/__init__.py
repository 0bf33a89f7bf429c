"""What is seen of an explanation: why a run was lost, and what cures it.

asked.py      how many runs are asked where nobody says it
answer.py     all that is printed: the cause by its name, one sentence with its evidence, the table
mechanisms.py how each mechanism is told of a run
driven.py     the same of a robot that is driven
recorded.py   what is told of a recorded log
met.py        which wall a beam was predicted to meet, and which it met
changes.py    what a change puts right, in words
tried.py      the table of what was tried, for a person and as CSV
picture.py    lost run and cured run over each other from where they part, NEES of both below
traces.py     what is drawn of each of the two on the map
"""
