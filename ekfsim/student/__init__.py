"""A filter of one's own: plugged in, held against the reference step by step, and graded.

    asked.py     one call of a filter, and who answers it
    fault.py     what is wrong with a student's code, in a line
    mistakes/    the known mistakes, and which of them its numbers are those of
    printed/     what programs in other languages wrote: tables of results, narratives

    own/         from the place of a student's code to a filter like any other
    sandbox/     the same code in a process of its own, which can be killed
    exposing/    which of the known mistakes an input exposes

What its code is given are copies, and what comes back of it is looked at before it is used.
"""
