"""Which of the known mistakes an input exposes: a filter that makes one is run on it.

exposed.py      the first step at which its numbers are not the right ones
statistics.py   what statistics of many runs alone would see of it
table.py        both as a table
"""
