"""Twins for many runs side by side, in NumPy."""
