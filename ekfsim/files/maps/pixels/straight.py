"""Outlines of steps → straight walls."""

import numpy as np

from ekfsim.geometry import Array


def corners(ring: Array) -> Array:
    """The points of a closed outline (n, 2) at which it turns."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    turning = before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]
    return np.asarray(ring[turning])
