"""Twins: quicker forms of functions of the text, held equal to it by one test.

table.py says which function each is the twin of and when it may stand in for it.
"""
