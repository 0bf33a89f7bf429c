"""Many beams close together, as those of a study's runs are: only the walls before all of them are
tried.

Seen from the middle of the beams, along their mean direction, none leaves the wedge

    |across| ≤ ρ + (along + ρ) tan δ
    ρ: how far the origins lie from the middle, δ: how far the directions part

which is convex: a wall with both ends beyond one of its sides is met by none. And where a wall bars
the whole wedge, none that lies wholly behind it is met either.
"""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.searches.few_walls import few_walls

SPREAD = 0.35  # rad; a beam that parts more from the others is left to itself
APART = 0.05  # of the walls' extent: and so is one that begins farther from them
LONE = 0.25  # share of such beams from which on the others do not count as close
FEWEST = 128  # beams that are worth a look
MANY_WALLS = 150  # before them, that are sooner searched for than all tried
SAFE = 1e-6  # of the coordinates' size: by so much the wedge is wider than it need be


def nearby_beams(
    ends: Array, x: Array, y: Array, dx: Array, dy: Array, span: Array
) -> tuple[Array, Integers, Integers] | None:
    """Ranges and walls of many beams, all (n,), and which beams are left in doubt; None where they
    lie too far apart.

    ends : (W, 4) m: x, y of the first and of the second end of each wall; span : (n,) m, the
    coordinates' size
    """
    if len(x) < FEWEST:
        return None
    apart = APART * float(np.ptp(ends))
    for middle in (np.mean, np.median):  # some that stray far move the mean, but not the median
        mx, my, ux, uy = (float(middle(each)) for each in (x, y, dx, dy))
        length = np.hypot(ux, uy)
        if length == 0:
            return None
        ux, uy = ux / length, uy / length
        from_x, from_y, cosine = np.abs(x - mx), np.abs(y - my), dx * ux + dy * uy
        close = (from_x <= apart) & (from_y <= apart) & (cosine >= np.cos(SPREAD))
        lone = np.flatnonzero(~close)
        if not len(lone):
            break
    if len(lone) > LONE * len(x):
        return None
    ρ = float(
        np.hypot(from_x.max(where=close, initial=0.0), from_y.max(where=close, initial=0.0))
        + SAFE * span.max()
    )
    tan_δ = float(np.sqrt(1 / cosine.min(where=close, initial=1.0) ** 2 - 1 + SAFE))
    before = _before(ends - [mx, my, mx, my], ux, uy, ρ, tan_δ)
    if len(before) > MANY_WALLS:
        return None
    if len(lone) == 0:
        ranges, walls, doubtful = few_walls(ends[before], x, y, dx, dy, span)
    else:
        some = np.flatnonzero(close)
        ranges, walls = np.full(x.shape, np.nan), np.full(x.shape, -1)
        ranges[some], walls[some], doubtful = few_walls(
            ends[before], *(each[some] for each in (x, y, dx, dy, span))
        )
        doubtful = np.concatenate([some[doubtful], lone])
    return ranges, np.append(before, -1)[walls], doubtful


def _before(ends: Array, ux: float, uy: float, ρ: float, tan_δ: float) -> Integers:
    """The walls that the beams may meet, in their order. ends : (W, 4) m, seen from their middle"""
    ax, ay, bx, by = ends.T
    along = np.stack([ax * ux + ay * uy, bx * ux + by * uy])
    across = np.stack([ax * uy - ay * ux, bx * uy - by * ux])
    half = ρ + (along + ρ) * tan_δ
    right, left = across > half, across < -half
    nearest, farthest = along.min(0), along.max(0)
    maybe = (farthest >= -ρ) & ~(right[0] & right[1]) & ~(left[0] & left[1])
    bars = (nearest > ρ) & (right[0] & left[1] | left[0] & right[1])
    limit = farthest.min(where=bars, initial=np.inf)
    return np.flatnonzero(maybe & (nearest <= limit))
