"""Twins for many runs side by side, in NumPy: worked out entry by entry, the same entry of all runs
lying together in memory.
"""
