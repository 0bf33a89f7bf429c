"""Twins for one robot, step after step: in plain floats, where arrays of a few numbers cost more
than what is worked out with them.
"""
