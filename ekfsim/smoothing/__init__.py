"""What a run looks like when it is over: every belief with the readings that came after it, too.

    rts.py       Steps → the same Steps, smoothed: Rauch-Tung-Striebel
    passing.py   how much of what is learnt of a state is told to the one before a motion
    shares.py    how honest a filter was at all steps of a run together

The smoother asks no filter: what it needs stands in the Steps.
"""

from ekfsim.smoothing.rts import smooth as smooth
from ekfsim.smoothing.rts import smoothed as smoothed
