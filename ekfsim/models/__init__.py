"""What the textbook calls f and h, each with its Jacobian under it and its noise.

A file per robot or sensor holds its equations and nothing else. `linearize`, what a filter asks
for, stands once, in protocols.py; what is quicker stands in fast/.
"""
