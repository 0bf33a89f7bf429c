"""A close look at pairs of a beam and a wall: which of its walls each beam meets first.

A search for many beams first finds, by whatever shortcut, a few walls that each beam may meet
first. What these pairs then come to is calculated here by the rules of rules.py.
"""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.rules import REACH, TIE, meet


def measure(ends: Array, x: Array, y: Array, dx: Array, dy: Array, span: Array) -> Array:
    """(n,): the range in m at which beams meet walls, pair by pair, inf where not: the same as
    `meet`, only sooner.

    ends : (n, 4) m; the beams' origins (x, y) in m and unit directions; span : (n,) m, the
    coordinates' size. Where the ends lie clearly on both sides of the beam, and its origin clearly
    off the wall, the crossing is all.
    """
    ax, ay, bx, by = ends.T
    ax, ay, bx, by = ax - x, ay - y, bx - x, by - y
    across_a, across_b = ax * dy - ay * dx, bx * dy - by * dx
    along_a, along_b = ax * dx + ay * dy, bx * dx + by * dy
    doubt = 4 * REACH * span * span
    sides, area = across_a * across_b, along_a * across_b - along_b * across_a
    with np.errstate(divide="ignore", invalid="ignore"):
        r = area / (across_b - across_a)
    r = np.where((sides < -doubt) & (r >= 0), r, np.inf)
    look = np.flatnonzero((np.abs(sides) <= doubt) | (np.abs(area) <= doubt) & (sides < -doubt))
    if look.size:
        seen = np.stack([along_a[look], across_a[look], along_b[look], across_b[look]])
        r[look] = meet(seen, REACH * span[look])
    return r


def first_of(
    which: Integers, wall: Integers, r: Array, span: Array, walls: int
) -> tuple[Array, Integers]:
    """The nearest wall of each beam, and of those within `tie` the lowest; nan and -1 for a beam
    without.

    which, wall, r : (pairs,), the beam, the wall and the range of each pair; span : (beams,) m;
    walls : how many exist
    """
    best = np.full(len(span), np.inf)
    np.minimum.at(best, which, r)
    equal = r <= (best + TIE * span)[which]
    lowest = np.full(len(span), walls)
    np.minimum.at(lowest, which[equal], wall[equal])
    met = best < np.inf
    return np.where(met, best, np.nan), np.where(met, lowest, -1)
