"""A close look at pairs of a beam and a wall: which of its walls each beam meets first.

A search for many beams first finds, by whatever shortcut, a few walls that each beam may meet
first. What these pairs then come to is calculated here by the rules of rules.py.
"""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.rules import REACH, TIE, meet


def measure(
    ends: Array, x: Array | float, y: Array | float, dx: Array, dy: Array, span: Array
) -> Array:
    """(n,): the range in m at which beams meet walls, pair by pair, inf where not.

    ends : (n, 4) m; the beams' origins (x, y) in m, or the one of all, and unit directions;
    span : (n,) m, the coordinates' size
    """
    ax, ay, bx, by = ends.T
    return crossing(seen(ax, ay, x, y, dx, dy), seen(bx, by, x, y, dx, dy), span)


def seen(
    px: Array | float, py: Array | float, x: Array | float, y: Array | float, dx: Array, dy: Array
) -> tuple[Array, Array]:
    """Where beams see points (px, py) m, or one point : `along` and `across` of rules.py, (n,) m"""
    ahead, aside = px - x, py - y
    return ahead * dx + aside * dy, ahead * dy - aside * dx


def crossing(a: tuple[Array, Array], b: tuple[Array, Array], span: Array) -> Array:
    """(n,): the same as `meet`, of walls whose ends a and b are seen like this, only sooner.

    Where the ends lie clearly on both sides of the beam, and its origin clearly off the wall, the
    crossing is all.
    """
    (along_a, across_a), (along_b, across_b) = a, b
    doubt = 4 * REACH * span * span
    sides, area = across_a * across_b, along_a * across_b - along_b * across_a
    with np.errstate(divide="ignore", invalid="ignore"):
        r = area / (across_b - across_a)
    clear = (sides < -doubt) & (np.abs(area) > doubt)
    r = np.where(clear & (r >= 0), r, np.inf)
    look = np.flatnonzero((sides <= doubt) & ~clear)
    if look.size:
        ends = np.stack([along_a[look], across_a[look], along_b[look], across_b[look]])
        r[look] = meet(ends, REACH * span[look])
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
