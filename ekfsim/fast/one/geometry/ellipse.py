"""geometry/ellipse.py of one covariance: a tenth of the time."""

import math

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ROUNDING, Ellipse, radius_factor


def ellipse(P: Array, probability: float) -> Ellipse | None:
    """λ₁ = m + r      λ₂ = det P / λ₁      φ = ½ atan2(P_xy, δ)"""
    if P.ndim != 2:
        return None
    a, b, c = float(P[0, 0]), float(P[0, 1]), float(P[1, 1])
    m, δ = (a + c) / 2, (a - c) / 2
    λ1, det = max(m + math.hypot(δ, b), 0.0), a * c - b * b
    λ2 = det / λ1 if λ1 and det > ROUNDING * λ1 * λ1 else 0.0
    φ = math.atan2(b, δ) / 2 % math.pi
    k = radius_factor(probability)
    return Ellipse(
        np.array(k * math.sqrt(λ1)),
        np.array(k * math.sqrt(λ2)),
        np.array(φ if φ < math.pi else 0.0),
    )
