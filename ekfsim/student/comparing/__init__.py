"""A student's filter against a reference, each step from the student's own belief.

reference.py     what a filter of ours makes of what is asked
compare.py       the steps of a run, one after another
difference.py    two answers to one question → which entries differ, in σ
rounding.py      how far right forms of the same equations may be apart
found.py         what is found in a run, or in N: the first wrong number, and all after it
naming.py        by which known mistakes it is explained
sides.py         who is called and beside which reference, as a scene names them
"""
