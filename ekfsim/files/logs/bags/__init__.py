"""Bags of ROS 1 and 2, and MCAP: their topics as the tables of a log.

bag.py        a bag → a recorded log
opening.py    a path → a reader of the package rosbags
declared.py   what it reads, for refusals and the docs
topics.py     which topic tells what
messages.py   when a message was stamped; its pose, heading, speeds
tables.py     messages → tables with named columns
odometry.py   poses and speeds that tell the motion
fixes.py      satellite fixes, on a plane that touches the earth
scans.py      laser scans, thinned to the beams that the world names
marks.py      poses of landmarks that a camera sees
made_world.py a world for a bag, where none is named
"""
