"""A student's filter against a reference, each step from the student's own belief.

compare.py       the steps of a run, one after another
difference.py    two answers to one question → which entries differ, in σ
rounding.py      how far right forms of the same equations may be apart
"""
