"""The keys of every kind of file, with their bounds, units and defaults.

world, system, instruments, sensors    worlds: walls, robots, what they carry
told, faults                           what the filter is told, and what is wrong
commands, drive                        commands files
recorded/                              recordings: formats, files, columns, topics
study, homework                        studies, and files of a course
fields                                 what keys are made of
"""
