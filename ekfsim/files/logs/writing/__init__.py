"""Simulated runs → recorded logs.

written.py     a run → a folder, in the format that is asked for
named.py       the format `log`, for every robot that drives
own.py         the formats of the logs that the robots themselves leave
handed_out.py  that of the classroom: what a course hands out
told_world.py  the world file that lies with a log: all as the filter is told
ticks.py       what a run is made of, and how its numbers are written
"""
