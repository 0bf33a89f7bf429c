"""Inputs that bring a filter down: short lists of commands, starts, told numbers, found by trying.

changes/      what may be changed of a scene: its commands, its start, one told number
goals.py      what is wanted of many runs of a scene, and how many of them do it
crew.py       many variants judged at once, here or in processes of this machine
search.py     from nothing to the best list: few runs for all, more for the best
shrinking.py  fewer commands, fewer obstacles, rounder numbers, while as many runs do it
exposing.py   the shortest input at which a filter's numbers are others than the reference's
hunt.py       what is asked → what was found, measured with a seed of its own
worlds.py     a world of which something is left out
written.py    what was found → a commands file that keeps its word, and a world file
"""
