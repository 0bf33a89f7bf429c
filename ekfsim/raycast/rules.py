"""The rules: what it means that a beam meets a wall, and where.

A wall is a straight line from a to b; a beam leaves its origin o in the unit direction d. Seen from
the beam, a point v lies `along` = (v − o)·d ahead and `across` = (v − o)×d to the right. A wall
whose ends lie on different sides is crossed, and the crossing is the mean of the ends' `along`,
each weighted with the other's distance across:

    r = (along_a across_b − along_b across_a) / (across_b − across_a)

What rounding must not decide is decided within `reach`, some units in the last place of the
coordinates:

- A beam that passes within reach of a wall's end hits that end. Edges that share a corner get the
  same numbers for it, so nothing slips between them.
- A beam along a wall hits its nearer end.
- A beam that starts within reach of a wall has range 0, whatever its direction.
- Of several walls at the same range (within `tie`), the one with the lowest index is hit.

A round wall is a circle of centre c and radius ρ. Its centre lies `along` ahead and `across` to the
right, and the beam's line cuts it where |across| < ρ:

    r = along ∓ half      half = √((ρ − |across|) (ρ + |across|))

From outside the nearer of the two is met, from inside the other, which lies ahead. Within `reach`:

- A beam that passes within reach of the circle touches it, where it comes nearest to the centre.
- A beam that starts within reach of the circle has range 0, whatever its direction.
- Round walls follow all straight ones in the order of their indices.
"""

import numpy as np

from ekfsim.geometry import Array

# of the coordinates' size: what an aimed beam misses its mark by, and to spare
REACH = 16 * float(np.finfo(float).eps)
TIE = 1e-12  # of the coordinates' size: ranges that differ by less are equal


def see(segments: Array, x: Array, y: Array, dx: Array, dy: Array) -> Array:
    """Walls as beams see them: `along` and `across` of the first end, then of the second, (4, …) m.

    segments : (…, 2, 2) m, broadcast with the beams' origins (x, y) m and unit directions (dx, dy)
    """
    ax, ay = segments[..., 0, 0] - x, segments[..., 0, 1] - y
    bx, by = segments[..., 1, 0] - x, segments[..., 1, 1] - y
    return np.stack([ax * dx + ay * dy, ax * dy - ay * dx, bx * dx + by * dy, bx * dy - by * dx])


def meet(seen: Array, reach: Array) -> Array:
    """The ranges at which beams meet the walls that they `see`, by the rules above : (…) m, inf
    where they do not.
    """
    along_a, across_a, along_b, across_b = seen
    at_a, at_b = np.abs(across_a) <= reach, np.abs(across_b) <= reach
    ahead, aside = along_b - along_a, across_b - across_a
    square = ahead * ahead + aside * aside
    # nearest to the origin
    foot = np.clip(-(along_a * ahead + across_a * aside) / np.where(square, square, 1), 0, 1)
    distance = np.hypot(along_a + foot * ahead, across_a + foot * aside)
    crossing = (along_a * across_b - along_b * across_a) / np.where(aside, aside, 1)
    r = np.where((across_a < 0) != (across_b < 0), crossing, np.inf)
    r = np.where(at_b, along_b, r)
    r = np.where(at_a, np.where(at_b, np.minimum(along_a, along_b), along_a), r)
    r = np.where(distance <= reach, 0.0, r)
    return np.where(r >= 0, r, np.inf)


def meet_round(circles: Array, x: Array, y: Array, dx: Array, dy: Array, reach: Array) -> Array:
    """The ranges at which beams meet round walls, by the rules above : (…) m, inf where they do
    not.

    circles : (…, 3) m, centre and radius, broadcast with origins and directions as in `see`
    """
    east, north, ρ = circles[..., 0] - x, circles[..., 1] - y, circles[..., 2]
    along, across = east * dx + north * dy, np.abs(east * dy - north * dx)
    distance = np.hypot(along, across)
    half = np.sqrt(np.maximum((ρ - across) * (ρ + across), 0.0))
    r = np.where(distance < ρ, along + half, along - half)
    r = np.where(across > ρ + reach, np.inf, r)
    r = np.where(np.abs(distance - ρ) <= reach, 0.0, r)
    return np.where(r >= 0, r, np.inf)
