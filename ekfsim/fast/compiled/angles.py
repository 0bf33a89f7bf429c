"""Angles on the circle, one at a time, compiled by Numba."""

import math

import numpy as np

from ekfsim.twins import compiled


@compiled
def wrapped(angle: float) -> float:
    """The same direction in (−π, π]: the twin of `wrap`."""
    if -math.pi < angle <= math.pi:
        return angle
    rest: float = np.fmod(angle, 2 * math.pi)
    if rest > math.pi:
        return rest - 2 * math.pi
    return rest + 2 * math.pi if rest <= -math.pi else rest
