"""Whether the truth is inside what is drawn of a belief."""

from ekfsim.diagnostics.nees import OUTSIDE, error, squared_mahalanobis
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.ellipse import cone_factor, radius_factor
from ekfsim.twins import twinned


@twinned
def inside_ellipse(belief: Gaussian, truth: Array, probability: float) -> Booleans:
    """Whether the true position lies inside the ellipse : (…)

    eᵀ P⁺ e ≤ k² on the position's block
    """
    e, P = error(belief, truth)[..., :2], belief.covariance[..., :2, :2]
    value, _, impossible = squared_mahalanobis(e, P)
    return ~impossible & (value <= radius_factor(probability) ** 2)


@twinned
def inside_cone(belief: Gaussian, truth: Array, probability: float) -> Booleans:
    """Whether the true heading lies inside the cone : (…)"""
    return within_cone(error(belief, truth)[..., 2], belief.covariance[..., 2, 2], probability)


def within_cone(e: Array, variance: Array, probability: float) -> Booleans:
    """Whether an error of the heading lies inside the cone : (…)

    e² ≤ k² σ_θ²
    """
    squared_reach = cone_factor(probability) ** 2 * variance
    return (e * e <= squared_reach) | ((variance <= 0) & (abs(e) <= OUTSIDE))
