"""What a notebook shows: tables, and what its cells make of scenes, steps, views and studies.

table.py  steps → the columns of `run --csv`
"""
