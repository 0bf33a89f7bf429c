"""The keys of every kind of file, with their bounds, units and defaults.

worlds/                 world files: floors, robots, what they carry, what the filter is told
commands, drive         commands files
filters                 filters by their names, and their numbers
recorded/               recordings: formats, files, columns, topics
study, homework         studies, and files of a course
fields                  what keys are made of
"""
