"""A run as one page for a browser, which plays without the program and without a network.

page.py      the page whole
writing.py   the page as a file
document.py  a text with its style and its script, and no other
holding.py   which of a run's views it holds
scenery.py   what stays the same from view to view: world, limits, colours, legend
told.py      what it holds of one view: words, beliefs, matrices
seen.py      what it draws of a reading
numbers.py   numbers as short as can be
browser/     its text, its style and its script, which are put into the page as they stand
"""
