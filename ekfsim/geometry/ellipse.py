"""From a covariance to what is drawn of it: the ellipse of a position, the cone of a heading."""

import math
from dataclasses import dataclass
from functools import cache
from statistics import NormalDist

import numpy as np

from ekfsim.geometry import Array
from ekfsim.twins import twinned

# a determinant below this share of λ₁² is rounding: a line
ROUNDING = 4 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class Ellipse:
    """Radii in m, orientation of the major axis in rad, in [0, π). All (…)."""

    major: Array
    minor: Array
    orientation: Array


def radius_factor(probability: float) -> float:
    """How many standard deviations the ellipse of this probability reaches: k = √(−2 ln(1 − p)).

    Two dimensions: 2 standard deviations hold only 86.5 % of a 2-D Gaussian.

    >>> round(radius_factor(0.954), 4)
    2.4816
    """
    return math.sqrt(-2 * math.log(1 - probability))


def cone_factor(probability: float) -> float:
    """How many standard deviations the heading's cone reaches to each side; one dimension.

    The assignment's ± 2σ goes by the name 95.4 % (it is 95.45 %).

    >>> cone_factor(0.954), round(cone_factor(0.99), 4)
    (2.0, 2.5758)
    """
    return 2.0 if probability == 0.954 else -NormalDist().inv_cdf((1 - probability) / 2)


@twinned
def ellipse(P: Array, probability: float) -> Ellipse:
    """The confidence ellipse of a position. P : (…, 2, 2) m² or larger, of which the first block is
    taken.

    λ₁ = m + r      λ₂ = det P / λ₁      φ = ½ atan2(P_xy, δ)      m, δ = ½(P_xx ± P_yy)
    r = √(δ² + P_xy²)

    >>> e = ellipse(np.diag([0.04, 0.01]), 0.954)
    >>> round(float(e.major), 4), round(float(e.minor), 4), float(e.orientation)
    (0.4963, 0.2482, 0.0)
    """
    a, b, c = P[..., 0, 0], P[..., 0, 1], P[..., 1, 1]
    m, δ = (a + c) / 2, (a - c) / 2
    λ1 = np.maximum(m + np.hypot(δ, b), 0.0)  # below 0 it is rounding, as det is
    det = a * c - b * b
    thin = (det <= ROUNDING * λ1 * λ1) | (λ1 == 0)
    λ2 = np.where(thin, 0.0, det) / np.where(thin, 1.0, λ1)
    φ = np.arctan2(b, δ) / 2 % np.pi
    k = radius_factor(probability)
    # an angle just below 0 rounds up to π itself
    return Ellipse(k * np.sqrt(λ1), k * np.sqrt(λ2), np.where(φ < np.pi, φ, 0.0))


def outline(center: Array, P: Array, probability: float, n: int = 73) -> Array:
    """Points on the confidence ellipse, the last equal to the first. center : (2,) m, P : (2, 2) m²
    → (n, 2) m
    """
    e = ellipse(P, probability)
    c, s = np.cos(e.orientation), np.sin(e.orientation)
    circle = unit_circle(n) * np.stack([e.major, e.minor])
    points: Array = center[:2] + circle @ np.array([[c, s], [-s, c]])
    return points


@cache
def unit_circle(n: int) -> Array:
    """Points on it, the last equal to the first : (n, 2)"""
    t = np.linspace(0, 2 * np.pi, n)
    return np.stack([np.cos(t), np.sin(t)], axis=-1)


def cone_halfwidth(variance: float, probability: float) -> float:
    """Half the opening of the heading's cone in rad. variance : σ_θ² in rad²"""
    return cone_factor(probability) * math.sqrt(max(variance, 0.0))


def conditioned(mean: Array, P: Array, offset: float) -> tuple[Array, Array]:
    """The position, were the heading known to lie `offset` rad from its mean.

    p | θ ~ N(p̂ + P_pθ/σ_θ² · offset,  P_pp − P_pθ P_θp/σ_θ²)
    mean : (3,), P : (3, 3) → (2,), (2, 2)

    Where the heading is certain there is nothing to learn: the position's own mean and covariance.
    """
    variance = P[2, 2]
    regression = P[:2, 2] / variance if variance > 0 else np.zeros(2)
    return mean[:2] + regression * offset, P[:2, :2] - np.outer(regression, P[2, :2])
