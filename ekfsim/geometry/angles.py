"""Angles on the circle."""

import math

import numpy as np

from ekfsim.geometry import Array


def wrap(angle: Array) -> Array:
    """The same direction in (−π, π]; an angle already there comes back untouched, to the last digit.

    angle : (…) rad

    >>> float(wrap(np.radians(270.0)) * 180 / np.pi)
    -90.0
    """
    turns = np.ceil((angle - np.pi) / (2 * np.pi))
    return np.where((angle > -np.pi) & (angle <= np.pi), angle, angle - 2 * np.pi * turns)


def wrap_one(angle: float) -> float:
    """The same for a single number, without the cost of an array.

    >>> wrap_one(-math.pi) == math.pi
    True
    """
    if -math.pi < angle <= math.pi:
        return angle
    return angle - 2 * math.pi * math.ceil((angle - math.pi) / (2 * math.pi))
