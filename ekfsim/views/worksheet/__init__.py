"""A narrative with gaps, which whoever learns fills in, and its solution beside it.

gaps.py     which numbers of a narrative can be calculated from what stands before them
choice.py   which of them are left out
sheets.py   the two sheets, in Markdown
"""
