"""What the files of a log are to hold, and how they are told apart: names, units, separators.

declared   a format's files and columns, from which come reader, refusals, schema and docs
names      other names of a column, and units in a first line
layout     separators, decimal commas, quotes, a first line with names or none
stamps     seconds, milliseconds, microseconds, nanoseconds
angles     radians, degrees
reading    a file → Rows, in s, m and rad
"""
