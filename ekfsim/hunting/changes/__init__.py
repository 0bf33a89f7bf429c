"""What is changed of a scene, and how such changes are made.

variants.py   other commands, another start, one number told otherwise
lists.py      short lists of moves and senses that a robot can do: made, changed, crossed
starts.py     places to begin at, likewise
told.py       the smallest change of one told number that is enough
"""
