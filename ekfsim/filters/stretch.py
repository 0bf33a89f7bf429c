"""Many EKF predictions in a row at once, for planar odometry."""

import numpy as np

from ekfsim.filters.algebra import symmetric
from ekfsim.filters.belief import Belief, Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import Motion


def stretch(belief: Belief, motion: Motion, U: Array) -> Gaussian:
    """The beliefs after each of N inputs, as EKF.predict gives them one by one: (N, …, 3), (N, …, 3, 3). U : (N, …, m)

    For motions of x = (x, y, θ) that are the same everywhere: a robot that is moved and turned goes the same way, moved
    and turned, D(θ) = Rot(θ) D(0). Headings and places are then cumulative sums, and with p the way from the start

        F = A(Δp)      A(p) = [1 0 −p_y;  0 1 p_x;  0 0 1]      A(p) A(q) = A(p + q)
        P_k = A(p_k) (P₀ + Σ_j≤k A(−p_j) W_j A(−p_j)ᵀ) A(p_k)ᵀ      W = G M Gᵀ + Q

    so that the covariances are cumulative sums, too. Held equal to EKF.predict in a loop by a test.
    """
    x, P = belief
    moved = motion.f(np.zeros_like(x), U)  # seen from where each step begins
    headings = wrap(x[..., 2] + np.cumsum(moved[..., 2], axis=0))
    before = np.zeros_like(moved)
    before[:1, ..., 2], before[1:, ..., 2] = x[..., 2], headings[:-1]
    c, s = np.cos(before[..., 2]), np.sin(before[..., 2])
    along, aside = moved[..., 0], moved[..., 1]
    way = np.cumsum(np.stack([c * along - s * aside, s * along + c * aside]), axis=1)
    G = motion.G(before, U)
    W = G @ motion.M(U) @ G.mT + motion.Q(U)
    places = np.moveaxis(way, (0, 1), (-2, -1))  # time is the last axis where it is summed and multiplied: faster
    summed = np.cumsum(_sheared(np.ascontiguousarray(np.moveaxis(W, 0, -1)), -places), axis=-1)
    covariances = np.moveaxis(_sheared(P[..., None] + summed, places), -1, 0)
    mean = np.stack([x[..., 0] + way[0], x[..., 1] + way[1], headings], axis=-1)
    return Gaussian(mean, symmetric(covariances))


def _sheared(P: Array, way: Array) -> Array:
    """A(p) P A(p)ᵀ : (…, 3, 3, N), in place; the uncertainty of a heading, seen a way p : (…, 2, N) further."""
    c = np.stack([-way[..., 1, :], way[..., 0, :]], axis=-2)
    P[..., :2, :, :] += c[..., :, None, :] * P[..., 2:, :, :]
    P[..., :, :2, :] += c[..., None, :, :] * P[..., :, 2:, :]
    return P
