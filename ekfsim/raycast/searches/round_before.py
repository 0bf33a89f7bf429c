"""The round walls that many beams close together may meet, as those of a study's runs: those in the
wedge of nearby_beams.py, and not behind all the straight walls that are met.
"""

from math import sqrt

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.round_walls import RoundWalls
from ekfsim.raycast.searches.nearby_beams import SAFE, SPREAD, Wedge


def round_before(
    walls: RoundWalls, straight: tuple[Array, Integers], beams: Array
) -> tuple[Array, Integers]:
    """`RoundWalls.before` of many beams (4, n), x, y in m and the unit direction."""
    x, y, dx, dy = beams
    return walls.before(straight, x, y, dx, dy, _in_wedge(walls, straight[0], beams))


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
