"""Commands of many runs.

studies.py   study, compare
hunting.py   hunt
tuning.py    tune
gallery.py   gallery
"""
