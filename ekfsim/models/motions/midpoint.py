"""The mid-point rule (document 000, section 3.1).

A way of D m is driven at the heading in the middle of a turn of T rad.
x = (x, y, θ) in m, m, rad : (…, 3); D, T : (…)
"""

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap


def arrival(x: Array, D: Array, T: Array) -> Array:
    """(x + D cos(θ + T/2),  y + D sin(θ + T/2),  θ + T)          eqs 16 to 18"""
    middle = x[..., 2] + T / 2
    return np.stack(
        [x[..., 0] + D * np.cos(middle), x[..., 1] + D * np.sin(middle), wrap(x[..., 2] + T)],
        axis=-1,
    )


def by_state(x: Array, D: Array, T: Array) -> Array:
    """∂/∂x : (…, 3, 3)          eq. 21.  Only the heading bends the way"""
    middle = x[..., 2] + T / 2
    J = np.zeros((*middle.shape, 3, 3))
    J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = 1
    J[..., 0, 2] = -D * np.sin(middle)
    J[..., 1, 2] = D * np.cos(middle)
    return J


def by_way(x: Array, D: Array, T: Array) -> Array:
    """∂/∂(D, T) : (…, 3, 2)"""
    middle = x[..., 2] + T / 2
    c, s = np.cos(middle), np.sin(middle)
    J = np.zeros((*middle.shape, 3, 2))
    J[..., 0, 0] = c
    J[..., 1, 0] = s
    J[..., 0, 1] = -D * s / 2
    J[..., 1, 1] = D * c / 2
    J[..., 2, 1] = 1
    return J
