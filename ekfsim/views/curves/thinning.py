"""Which rows of a long run are enough for a plot: its peaks are among them."""

from itertools import pairwise

import numpy as np

from ekfsim.geometry import Array, Integers

ENOUGH = 1000  # stretches of a run, each about as wide as the thinnest line that can be seen
SHORT = 4  # rows to a stretch, up to which there is nothing to be left out


def is_long(n: int, stretches: int = ENOUGH) -> bool:
    """Whether so many rows are more than a plot can show."""
    return n > SHORT * stretches


def peaks(columns: Array, stretches: int = ENOUGH) -> Integers:
    """The rows of the least and the greatest number of every column in each of so many stretches,
    with the first and the last row of each, in ascending order. All rows of a run that is not long.

    columns : (N, m), nan where there is nothing to draw; → (k,)
    """
    n = len(columns)
    if not is_long(n, stretches):
        return np.arange(n)
    edges = np.linspace(0, n, stretches + 1).astype(np.int64)
    kept = np.zeros(n, np.bool_)
    kept[edges[:-1]] = kept[edges[1:] - 1] = True
    # a nan is neither the least nor the greatest
    low, high = (np.where(np.isnan(columns), bound, columns) for bound in (np.inf, -np.inf))
    for first, end in pairwise(edges.tolist()):
        kept[first + low[first:end].argmin(axis=0)] = True
        kept[first + high[first:end].argmax(axis=0)] = True
    return np.flatnonzero(kept)
