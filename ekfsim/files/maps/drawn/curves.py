"""Curves → the corners of lines that stay near them."""

from collections.abc import Callable

import numpy as np

from ekfsim.geometry import Array

HALVINGS = 12  # at most: 4096 pieces of a curve
WITHIN = 0.01  # m, where nobody says otherwise


def flat(at: Callable[[float], tuple[float, float]], tolerance: float) -> Array:
    """The corners of lines between two points of a curve, the first left out : (n, 2)

    at : the curve, t in [0, 1] → a point; tolerance : how far it may lie from the lines
    """

    def rest(t0: float, p0: Array, t1: float, p1: Array, left: int) -> list[Array]:
        quarters = np.array([at(t0 + share * (t1 - t0)) for share in (0.25, 0.5, 0.75)])
        if left == 0 or np.max(_off(quarters, p0, p1)) <= tolerance:
            return [p1]
        middle, t = quarters[1], (t0 + t1) / 2
        return [*rest(t0, p0, t, middle, left - 1), *rest(t, middle, t1, p1, left - 1)]

    return np.array(rest(0.0, np.array(at(0.0)), 1.0, np.array(at(1.0)), HALVINGS))


def _off(points: Array, a: Array, b: Array) -> Array:
    """How far points (n, 2) lie from the line between two others."""
    way = b - a
    length = float(way @ way)
    share = np.clip((points - a) @ way / length, 0, 1) if length else np.zeros(len(points))
    return np.asarray(np.hypot(*(points - a - share[:, None] * way).T))
