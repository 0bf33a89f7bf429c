"""Commands of files.

files.py   check, schema, list, show, new, figures
maps.py    world
"""
