"""Twins: quicker forms of functions of the text, held equal to it by one test.

table.py says which function each is the twin of and when it may stand in for it.

    one/           in plain floats: arrays of nine numbers cost more to make than to calculate
    many/          runs of a study side by side, entry by entry: (3, 3, N)
    compiled/      the same by Numba: the extra `fast`; of the classroom a whole block
    chi_square.py  quantiles without SciPy
    stretches.py   motion inputs that follow one another, by many_steps.py
    records.py     many records at once
    written.py     a driven robot's log, and
    summary.py     the summary of its run, many ticks at once
"""
