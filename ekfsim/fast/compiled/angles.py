"""Angles on the circle, compiled by Numba."""

import math

import numpy as np

from ekfsim.geometry import Array
from ekfsim.twins import compiled

PER_QUARTER = 2 / math.pi
# π/2 in two parts, the first of so few digits that a few million quarters of it are exact
QUARTER, REST = 1.5707963267341256, 6.077100506506192e-11
FAR = 1e6  # rad; beyond, the reduction to a quarter of a turn costs digits


@compiled
def directions(angle: Array, cosine: Array, sine: Array) -> None:
    """Cosines and sines of many angles, several at a time: all (N,)

    Quarters of a turn are taken from an angle until an eighth is left of it at most (Cody & Waite,
    Software Manual for the Elementary Functions, 1980), where Taylor's series err less than
    rounding does.
    """
    near = True
    for n in range(len(angle)):
        near &= abs(angle[n]) < FAR
    if not near:
        for n in range(len(angle)):
            cosine[n], sine[n] = math.cos(angle[n]), math.sin(angle[n])
        return
    for n in range(len(angle)):
        k = np.floor(angle[n] * PER_QUARTER + 0.5)
        r = (angle[n] - k * QUARTER) - k * REST
        z = r * r
        s = 1 / 6227020800 - z / 1307674368000
        s = -1 / 5040 + z * (1 / 362880 + z * (-1 / 39916800 + z * s))
        s = r + r * z * (-1 / 6 + z * (1 / 120 + z * s))
        c = 1 / 479001600 + z * (-1 / 87178291200 + z / 20922789888000)
        c = -1 / 720 + z * (1 / 40320 + z * (-1 / 3628800 + z * c))
        c = 1 - z * (1 / 2 - z * (1 / 24 + z * c))
        quarter = k - 4 * np.floor(k / 4)
        upright = (quarter == 1) | (quarter == 3)
        along, across = s if upright else c, c if upright else s
        cosine[n] = -along if (quarter == 1) | (quarter == 2) else along
        sine[n] = -across if quarter >= 2 else across


@compiled
def wrapped(angle: float) -> float:
    """The same direction in (−π, π]: the twin of `wrap`."""
    if -math.pi < angle <= math.pi:
        return angle
    rest: float = np.fmod(angle, 2 * math.pi)
    if rest > math.pi:
        return rest - 2 * math.pi
    return rest + 2 * math.pi if rest <= -math.pi else rest
