"""A reading of range and bearing, in Cartesian coordinates (document 001, section II D)."""

import numpy as np

from ekfsim.geometry import Array


def cartesian(reading: Array) -> Array:
    """(x, y) = (r cos θ, r sin θ)          eq. 18; reading = (r, θ) in m, rad : (…, 2) → (…, 2) m

    >>> cartesian(np.array([2.0, np.pi / 6])).round(4).tolist()
    [1.7321, 1.0]
    """
    r, θ = reading[..., 0], reading[..., 1]
    return np.stack([r * np.cos(θ), r * np.sin(θ)], axis=-1)


def cartesian_jacobian(reading: Array) -> Array:
    """∇f = [[cos θ, −r sin θ], [sin θ, r cos θ]] : (…, 2, 2)          eq. 19"""
    r, c, s = reading[..., 0], np.cos(reading[..., 1]), np.sin(reading[..., 1])
    return np.stack([np.stack([c, -r * s], axis=-1), np.stack([s, r * c], axis=-1)], axis=-2)


def cartesian_moments(
    reading: Array, range_sigma: float, bearing_sigma: float
) -> tuple[Array, Array]:
    """Exact mean (2,) and covariance (2, 2) of (x, y) where range and bearing are Gaussian.

    E x = r e^(−σ²/2) cos θ      E y = r e^(−σ²/2) sin θ      with q = r² + σ_r² and k = e^(−2σ²)
    E x² = q (1 + k cos 2θ)/2      E y² = q (1 − k cos 2θ)/2      E xy = q k sin 2θ / 2
    """
    r, θ = reading
    mean = np.exp(-(bearing_sigma**2) / 2) * cartesian(reading)
    q, k = r**2 + range_sigma**2, np.exp(-2 * bearing_sigma**2)
    c, s = k * np.cos(2 * θ), k * np.sin(2 * θ)
    return mean, q / 2 * np.array([[1 + c, s], [s, 1 - c]]) - np.outer(mean, mean)
