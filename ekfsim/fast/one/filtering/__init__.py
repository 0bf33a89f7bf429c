"""Twins of the filters and of how their beliefs are judged, for one robot."""
