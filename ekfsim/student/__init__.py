"""A filter of one's own: plugged in, held against the reference step by step, and graded.

    asked.py     one call of a filter, and who answers it
    fault.py     what is wrong with a student's code, in a line
    own/         from the place of a student's code to a filter like any other
    mistakes/    the known mistakes, and which of them a student's numbers are those of
    comparing/   each step beside the reference: the first wrong number, and what explains it
    printed/     the same of what programs in other languages wrote: tables, narratives
    exposing/    which of the known mistakes an input exposes
    sandbox/     a student's code in a process of its own, which can be killed
    grading/     submissions → points and words

What its code is given are copies, and what comes back of it is looked at before it is used.
"""
