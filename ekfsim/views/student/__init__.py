"""What is told of students' filters.

difference.py    the first wrong number, what explains it, and all that shows after it
narrative.py     the wrong numbers of what another program printed
telling.py       how both tell a wrong number
exposing.py      which known mistakes an input exposes
"""
