"""The classroom's motion of many runs, its sine and cosine taken once."""

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.soa import from_soa, soa_zeros
from ekfsim.models.motions.move_turn import MoveTurn


def move_turn_f(motion: MoveTurn, x: Array, u: Array) -> Array:
    """Twin of `MoveTurn.f`."""
    θ, d = x[..., 2], u[..., 0]
    after = x[..., 0] + d * np.cos(θ), x[..., 1] + d * np.sin(θ), wrap(θ + u[..., 1])
    return from_soa(np.stack(after), 1)


def move_turn(motion: MoveTurn, x: Array, u: Array) -> tuple[Array, Array, Array, Array, float]:
    """Twin of f, F, G, M and Q of `MoveTurn`."""
    axes = np.broadcast_shapes(x.shape[:-1], u.shape[:-1])
    x_new, F, G, M = (soa_zeros(axes, *inner) for inner in ((3,), (3, 3), (3, 2), (2, 2)))
    θ, d, a = x[..., 2], u[..., 0], u[..., 1]
    c, s = np.cos(θ), np.sin(θ)
    F[..., 0, 0] = F[..., 1, 1] = F[..., 2, 2] = G[..., 2, 1] = 1
    G[..., 0, 0], G[..., 1, 0] = c, s
    F[..., 1, 2] = d * c
    F[..., 0, 2] = -d * s
    x_new[..., 0] = x[..., 0] + F[..., 1, 2]
    x_new[..., 1] = x[..., 1] - F[..., 0, 2]
    x_new[..., 2] = wrap(θ + a)
    M[..., 0, 0] = np.square(motion.distance_ratio * d)
    M[..., 1, 1] = np.square(motion.angle_ratio * a)
    return x_new, F, G, M, 0.0
