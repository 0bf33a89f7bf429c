"""What programs in other languages wrote, held against the reference as far as its digits go.

digits.py     how much a printed number leaves open, and what that makes of a step
columns.py    the names of numbers → which number a column holds
table.py      a table of results → rows
results.py    rows beside a run: of which step, in which units
steps.py      each step from the file's own row before it
held.py       a file beside what the reference makes of a scene
narrative/    what a program printed, number by number
"""
