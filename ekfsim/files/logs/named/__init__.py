"""The log format for everybody: tables whose columns have names.

declared.py    what its files hold, for refusals and the docs
log.py         a folder, or one file → a recorded log
files.py       which of its files hold what
head.py        the names of its columns, and their units
tables.py      lines → a table with named columns, in s, m and rad
motion.py      what the robot did, each over its time
inputs.py      that → inputs of the world's motion model
readings.py    what was measured → readings of the world's sensors
sigmas.py      how sure each reading is, where its row tells
places.py      landmarks and true poses
made_world.py  a world that fits the columns, where none is named
"""
