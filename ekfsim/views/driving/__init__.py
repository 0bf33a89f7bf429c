"""A run whose commands are thought of as it goes: driven now, and a commands file afterwards.

course.py   the run so far, command by command, and the way back
saving.py   its commands file, which plays the same run
"""
