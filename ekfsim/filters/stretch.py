"""Many EKF predictions in a row at once, for planar odometry."""

import numpy as np

from ekfsim.filters.algebra import symmetric
from ekfsim.filters.belief import Belief, Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import Motion


def stretch(belief: Belief, motion: Motion, U: Array) -> Gaussian:
    """The beliefs after each of N inputs, as EKF.predict gives them one by one: (N, …, 3), (N, …, 3, 3). U : (N, …, m)

    For motions of x = (x, y, θ) that turn by an angle which does not depend on x and go a way that depends on θ alone.
    Headings and places are then cumulative sums, and with p the way from the start,

        F = A(Δp)      A(p) = [1 0 −p_y;  0 1 p_x;  0 0 1]      A(p) A(q) = A(p + q)
        P_k = A(p_k) (P₀ + Σ_j≤k A(−p_j) W_j A(−p_j)ᵀ) A(p_k)ᵀ      W = G M Gᵀ + Q

    so that the covariances are cumulative sums, too. Held equal to EKF.predict in a loop by a test.
    """
    x, P = belief
    turned = np.cumsum(motion.f(np.zeros_like(x), U)[..., 2], axis=0)
    before = np.zeros((*turned.shape, 3))
    before[..., 2] = x[..., 2]
    before[1:, ..., 2] = wrap(x[..., 2] + turned[:-1])
    way = np.cumsum(motion.f(before, U)[..., :2], axis=0)
    mean = np.concatenate([x[..., :2] + way, wrap(x[..., 2] + turned)[..., None]], axis=-1)
    G = motion.G(before, U)
    W = G @ motion.M(U) @ G.mT + motion.Q(U)
    back, forth = _A(-way), _A(way)
    from_start = P + np.cumsum(back @ W @ back.mT, axis=0)
    return Gaussian(mean, symmetric(forth @ from_start @ forth.mT))


def _A(way: Array) -> Array:
    """∂(x, y, θ)/∂(x, y, θ) over a way (…, 2) : (…, 3, 3)"""
    A = np.zeros((*way.shape[:-1], 3, 3))
    A[..., 0, 0] = A[..., 1, 1] = A[..., 2, 2] = 1
    A[..., 0, 2], A[..., 1, 2] = -way[..., 1], way[..., 0]
    return A
