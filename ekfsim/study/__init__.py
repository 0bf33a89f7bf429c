"""N runs at once, sweeps of their numbers, and the machines that they run on: from one run to a
million.
"""
