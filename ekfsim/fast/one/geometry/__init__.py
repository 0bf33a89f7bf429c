"""Twins of angles, ellipses, and of what a beam meets, for one robot."""
