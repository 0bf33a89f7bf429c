"""N runs at once, sweeps of their numbers, and the machines that they run on: from one run to a
million.

plan.py        what is asked → cases, in blocks   results.py      Tally → numbers with uncertainty
block.py       1024 runs → a Tally                verdict.py      what they say of a filter
counting.py    the runs at one step → counts      expectation.py  what a scene promises
tally.py       records that add                   tables.py       CSV
comparison.py  two settings side by side, by      running/        engines, clusters, the journal
pairs.py       differences of pairs of runs       code.py         that of filters of one's own
"""
