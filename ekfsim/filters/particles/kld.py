"""How many particles are enough (KLD sampling): Fox, Adapting the sample size in particle filters
through KLD-sampling, 2003; Thrun, Burgard & Fox, Probabilistic Robotics, 2005, Table 8.4.
"""

import math
from collections.abc import Sequence

import numpy as np

from ekfsim.geometry import Array, Integers

FEWEST = 300  # particles, however sure they are
BIN, BIN_ANGLE = 0.2, math.radians(5.0)  # m, rad: what counts as another place
KLD = 0.05  # how far the crowd may be from what it stands for, in nats …
Z_99 = 2.3263478740408408  # … in 99 % of draws: the normal quantile
MIXED = 1_000_003  # more than there are bins along any axis


def enough(k: int) -> int:
    """How many particles are enough for k occupied bins: (k − 1)/2ε (1 − a + √a z)³, a = 2/(9 (k −
    1)): Fox, 2003, eq. 7

    >>> enough(1), enough(10), enough(100)
    (300, 300, 1347)
    """
    if k <= 1:
        return FEWEST
    a = 2 / (9 * (k - 1))
    return max(FEWEST, math.ceil((k - 1) / (2 * KLD) * (1 - a + math.sqrt(a) * Z_99) ** 3))


def cells(states: Array, bins: Array) -> Integers:
    """In which bin each of the particles (…, p, n) lies, as one number : (…, p)"""
    digits = np.floor(states / bins).astype(np.int64)
    # may overflow: it only tells bins apart
    number: Integers = digits @ np.multiply.accumulate(np.full(len(bins), MIXED))
    return number


def occupied(cells: Integers) -> Integers:
    """How many different bins there are among those of p particles : (…). cells : (…, p)

    >>> occupied(np.array([[7, 3, 7, 3], [5, 5, 5, 5]])).tolist()
    [2, 1]
    """
    ordered = np.sort(cells, axis=-1)
    number: Integers = 1 + np.count_nonzero(ordered[..., 1:] != ordered[..., :-1], axis=-1)
    return number


def bins(n: int, headings: Sequence[int]) -> Array:
    """How wide a bin is in each of n entries of the state : (n,)"""
    widths = np.full(n, BIN)
    widths[list(headings)] = BIN_ANGLE
    return widths
