"""All scenarios that come along, side by side: a web site of pages that play, or one page of
Markdown.

making.py    which scenarios, and the folder whole
exhibit.py   one scenario: its page, its picture, its figures
cures.py     what each cure makes of it
still.py     the last view of a run, small
site.py      index.html                          markdown.py  the same as Markdown
browser/     the site's text and style
"""
