"""Quantiles of χ² without SciPy, which takes longer to import than a short run to calculate."""

import math
from functools import lru_cache

LARGEST = 5_000  # degrees of freedom; far beyond it lgamma loses digits
SOLVED = 1e-9  # of the root; a Newton step as small as this leaves rounding alone


@lru_cache(maxsize=4096)
def quantile(probability: float, dof: int) -> float | None:
    """The value that a χ² variable stays below with this probability. None for what it does not
    suit.

    Newton's method for the smaller tail at y = x/2, on its logarithm, held between two bounds.
    """
    upper = 1 - probability
    if not (1 <= dof <= LARGEST and dof == int(dof) and 0 < upper < 1):
        return None
    a, beyond = dof / 2, upper < 0.5
    goal = math.log(upper if beyond else 1 - upper)
    low, high = 0.0, 2 * a + 800.0  # no float is as close to 1 as what lies below that
    y = a
    for _ in range(200):
        above, below, density = tails(a, y)
        tail = above if beyond else below
        missing = (math.log(tail) - goal) if tail > 0 else -math.inf
        if (missing > 0) == beyond:
            low = y
        else:
            high = y
        # d log(tail) / d log y = ∓ y · density / tail
        step = (1 if beyond else -1) * missing * tail / density if tail > 0 and density > 0 else 1e9
        following = y * math.exp(step) if abs(step) < 1 else -1.0
        if abs(step) < SOLVED:
            return 2 * following
        y = following if low < following < high else (low + high) / 2
    return None


def tails(a: float, y: float) -> tuple[float, float, float]:
    """Q(a, y) and P(a, y), of which the one that is not summed is 1 less the other, and y^a e^−y /
    Γ(a), for a = 1/2, 1, 3/2 …

    Abramowitz & Stegun, Handbook of Mathematical Functions, 1964, 26.4.4 to 26.4.6: sums of terms
    that are all positive.
    """
    density = math.exp(a * math.log(y) - y - math.lgamma(a))
    if y < a:
        n, term, total = a, density / a, 0.0
        while term > total * 1e-17:
            total += term
            n += 1
            term *= y / n
        return 1 - total, total, density
    n, term, total = a - 1, density / y, 0.0
    while n >= 0 and term > total * 1e-17:
        total += term
        term *= n / y
        n -= 1
    if a != int(a):
        total += math.erfc(math.sqrt(y))
    return total, 1 - total, density
