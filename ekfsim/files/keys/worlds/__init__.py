"""The keys of a world file.

world                             all of them
floor                             obstacles, walls, landmarks
robot, estimated                  what a robot measures of its motion, and what its filter finds out
instruments, carried, sensors     each kind of sensor; what all have; the list of them
told, faults                      what the filter is told, and what is wrong
documents, by_system              what each document's system has, and may have
"""
