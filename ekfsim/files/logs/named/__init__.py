"""The log format for everybody: tables whose columns have names.

log.py        a folder, or one file → a recorded log
files.py      which files of a folder hold what
tables.py     lines → a table with named columns, in s, m and rad
motion.py     what the robot did → inputs of the world's motion model
readings.py   what was measured → readings of the world's sensors
places.py     landmarks and true poses
made_world.py a world that fits the columns, where none is named
"""
