"""What a program printed in the assignment's format, number by number.

reading.py      lines → the numbers of each step
numbers.py      a number beside what the numbers before it make of it
hanging.py      what follows from the other numbers of a step, in any run
uncertainty.py  ellipse and cone, from the printed covariance
beside.py       what follows from the run: odometry, ranges, the map
found.py        what is wrong, from the first line on
"""
