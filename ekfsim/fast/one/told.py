"""What the narrative says of one belief, in plain floats."""

import math
import sys

import numpy as np

from ekfsim.diagnostics.nees import OUTSIDE, ROUNDING
from ekfsim.fast.many.nees import CLEAR
from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.ellipse import cone_factor, radius_factor

SMALL = 64  # numbers of a matrix, at most


def inside_ellipse(belief: Gaussian, truth: Array, probability: float) -> Booleans | None:
    """Whether one true position lies inside the ellipse, where that has clearly two radii."""
    if truth.ndim > 1 or belief.mean.ndim > 1:
        return None
    (x, y, _), (tx, ty, _) = belief.mean.tolist(), truth.tolist()
    (a, b, _), (_, d, _), _ = belief.covariance.tolist()
    if not (a > ROUNDING**2 and d > ROUNDING**2):
        return None
    D = d - b * b / a
    if not CLEAR * d < D:
        return None
    ex = x - tx
    across = y - ty - b / a * ex
    return np.array(ex * ex / a + across * across / D <= radius_factor(probability) ** 2)


def inside_cone(belief: Gaussian, truth: Array, probability: float) -> Booleans | None:
    """Whether one true heading lies inside the cone."""
    if truth.ndim > 1 or belief.mean.ndim > 1:
        return None
    e = wrap_one(float(belief.mean[2]) - float(truth[2]))
    variance = float(belief.covariance[2, 2])
    reached = e * e <= cone_factor(probability) ** 2 * variance
    return np.array(reached or (variance <= 0 and abs(e) <= OUTSIDE))


def cleared(A: Array, rounding: float) -> list[list[float]] | None:
    """The rows of a small matrix without what is rounding beside the rest."""
    if A.size > SMALL:
        return None
    rows = A.tolist()
    n = len(rows)
    if A.shape == (n, n) and all(rows[i][i] >= 0 for i in range(n)):
        σ = [math.sqrt(rows[i][i]) for i in range(n)]
        if _symmetric(rows, σ, rounding):
            return [
                [
                    0.0 if abs(a) < rounding * (σ_i * σ_j) else a
                    for a, σ_j in zip(row, σ, strict=True)
                ]
                for row, σ_i in zip(rows, σ, strict=True)
            ]
    size = [[_sized(a) for a in row] for row in rows]
    columns = [max(column) for column in zip(*size, strict=True)]
    beside = [[max(max(row), column) for column in columns] for row in size]
    return [
        [0.0 if abs(a) < rounding * least else a for a, least in zip(row, near, strict=True)]
        for row, near in zip(rows, beside, strict=True)
    ]


def _symmetric(rows: list[list[float]], σ: list[float], rounding: float) -> bool:
    """Whether a matrix is symmetric, but for what is rounding beside σᵢ σⱼ."""
    if rows == [list(column) for column in zip(*rows, strict=True)]:
        return math.inf not in σ
    return all(
        abs(a - b) <= rounding * (σ_i * σ_j)
        for row, column, σ_i in zip(rows, zip(*rows, strict=True), σ, strict=True)
        for a, b, σ_j in zip(row, column, σ, strict=True)
    )


def _sized(a: float) -> float:
    """|a|, 0 of nan, and the largest number in place of infinity."""
    return 0.0 if math.isnan(a) else min(abs(a), sys.float_info.max)
