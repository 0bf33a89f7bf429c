"""Angles on the circle."""

import numpy as np

from ekfsim.geometry import Array


def wrap(angle: Array) -> Array:
    """The same direction in (−π, π]; an angle already there comes back untouched, to the last
    digit.

    angle : (…) rad

    >>> float(wrap(np.radians(270.0)) * 180 / np.pi)
    -90.0
    """
    if np.ndim(angle) and np.all((angle > -np.pi) & (angle <= np.pi)):
        return np.array(angle)
    # exact, as are the sums below: no rounding leads out of the range
    rest = np.fmod(angle, 2 * np.pi)
    return np.where(
        rest > np.pi, rest - 2 * np.pi, np.where(rest <= -np.pi, rest + 2 * np.pi, rest)
    )
