"""What is no file: text, dicts and values of Python, read with all the checks of files; and what
was read, changed by single numbers.

given.py    a file's text or a tree of values, and how messages name it
tree.py     values of Python → the same tree that a text grows to
worlds.py   World.of
changes.py  with_, which means what --set means
"""
