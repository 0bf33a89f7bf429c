"""The NEES of one pose in plain floats: P = L D Lᵀ, where its rank is clear without eigenvalues."""

import numpy as np

from ekfsim.diagnostics.nees import ROUNDING
from ekfsim.fast.many.nees import CLEAR
from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.filters.belief import Belief, posed
from ekfsim.geometry import Array
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Nees


def nees(belief: Belief, truth: Array, layout: Layout = POSE) -> Nees | None:
    """The NEES of one pose whose P is clearly of full rank, in plain floats."""
    if truth.ndim > 1 or belief.mean.ndim > 1:
        return None
    pose = posed(belief, layout)
    (x, y, θ), (tx, ty, tθ) = pose.mean.tolist(), truth.tolist()
    value = square([x - tx, y - ty, wrap_one(θ - tθ)], pose.covariance.tolist())
    return None if value is None else Nees(np.array(value), np.array(3), np.array(False))


def square(e: list[float], P: list[list[float]]) -> float | None:
    """eᵀ P⁻¹ e, None where P is not clearly of full rank; see many/nees.py."""
    (a, b, _), (c, d, _), (p, q, r) = P
    if not (a > ROUNDING**2 < d and r > ROUNDING**2):
        return None
    k = c / a
    D = d - k * b
    if not CLEAR * d < D:
        return None
    m = p / a
    n = (q - m * b) / D
    D3 = r - m * p - n * n * D
    if not CLEAR * d * r < D * D3:
        return None
    y = e[1] - k * e[0]
    y3 = e[2] - m * e[0] - n * y
    return e[0] * e[0] / a + y * y / D + y3 * y3 / D3
