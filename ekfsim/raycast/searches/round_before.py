"""The round walls that many beams may meet. Of beams close together, as those of a study's runs, it
is those in the wedge of nearby_beams.py, and not behind all the straight walls that are met. Where
these are many, each beam is followed by itself through the cells of round_cells.py.
"""

from math import sqrt

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.brute import nearer
from ekfsim.raycast.round_walls import RoundWalls
from ekfsim.raycast.rules import TIE
from ekfsim.raycast.searches.nearby_beams import SAFE, SPREAD, Wedge

MANY = 64  # circles that are sooner all tried by many beams


def round_before(
    walls: RoundWalls, straight: tuple[Array, Integers], beams: Array
) -> tuple[Array, Integers]:
    """`RoundWalls.before` of many beams (4, n), x, y in m and the unit direction."""
    x, y, dx, dy = beams
    some = _in_wedge(walls, straight[0], beams)
    if (len(walls.circles) if some is None else len(some)) <= MANY:
        return walls.before(straight, x, y, dx, dy, some)
    near = np.abs(x) + np.abs(y) < walls.cells.horizon
    if not (near.all() and np.isfinite(beams[2:]).all()):
        return walls.before(straight, x, y, dx, dy, some)
    met = walls.cells.first(beams, np.where(np.isnan(straight[0]), np.inf, straight[0]))
    return nearer(straight, met, walls.first, TIE * (walls.extent + np.abs(x) + np.abs(y)))


def _in_wedge(walls: RoundWalls, ranges: Array, beams: Array) -> Integers | None:
    """Which circles beams may meet before what is so far off : (n,) m; None for all of them."""
    low, high = beams.min(axis=1), beams.max(axis=1)
    if not np.isfinite(low + high).all():
        return None
    x, y, dx, dy, _, ρ, sin_δ = Wedge.of(low, high)
    if sin_δ > SPREAD:
        return None
    ρ += SAFE * (walls.extent + abs(x) + abs(y))
    tan_δ = sin_δ / sqrt(1 - sin_δ**2) + SAFE
    cx, cy, radius = walls.circles.T
    east, north = cx - x, cy - y
    along, across = east * dx + north * dy, east * dy - north * dx
    before = np.abs(across) <= radius + ρ + np.maximum(along + radius + ρ, 0.0) * tan_δ
    before &= along + radius >= -ρ
    if (farthest := ranges.max()) < np.inf:  # none of them is nan
        before &= along - radius <= farthest + ρ
    return np.flatnonzero(before)
