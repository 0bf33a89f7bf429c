"""Many EKF predictions in a row at once."""

import numpy as np

from ekfsim.filters.arithmetic.square_root import covariance
from ekfsim.filters.belief import Belief, Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.noise import once
from ekfsim.models.protocols import Motion


def stretch(belief: Belief, motion: Motion, U: Array) -> Gaussian:
    """The beliefs after each of N inputs.

    A robot that is moved and turned goes the same way, moved and turned, D(θ) = Rot(θ) D(0).
    Headings and places are then cumulative
    sums, and with p the way from the start

        F = A(Δp)      A(p) = [1 0 −p_y;  0 1 p_x;  0 0 1]      A(p) A(q) = A(p + q)
        P_k = A(p_k) (P₀ + Σ_j≤k A(−p_j) W_j A(−p_j)ᵀ) A(p_k)ᵀ      W = G M Gᵀ + Q

    so that the covariances are cumulative sums, too.
    """
    mean = moved(belief.mean, motion, U)
    before = np.concatenate([belief.mean[None], mean[:-1]])[: len(mean)]
    return propagated(belief, mean, motion.G(before, U), motion.M(U), motion.Q(U))


def propagated(belief: Belief, mean: Array, G: Array, M: Array, Q: Array | float) -> Gaussian:
    """The same where the means, G, M and Q are known of each input."""
    x, P = belief
    way = (mean - x)[..., :2].T
    from_start = P.T[..., None] + np.cumsum(_sheared(_noise(G, once(M), Q), -way), axis=-1)
    return Gaussian(mean, covariance(_sheared(from_start, way).T))


def _noise(G: Array, M: Array, Q: Array | float) -> Array:
    """G M Gᵀ + Q : (3, 3, …, N), entry by entry where M is diagonal."""
    n = M.shape[-1]
    if M[..., ~np.eye(n, dtype=bool)].any():
        return np.ascontiguousarray((G @ M @ G.mT + Q).T)
    columns = np.ascontiguousarray(G.T)  # (m, 3, …, N)
    W = np.zeros((3, 3, *columns.shape[2:]))
    for column, variance in zip(columns, M.diagonal(0, -2, -1).T, strict=True):
        if variance.any():
            for i, scaled in enumerate(column * variance):
                for j in range(i + 1):
                    W[i, j] += scaled * column[j]
    W[0, 1], W[0, 2], W[1, 2] = W[1, 0], W[2, 0], W[2, 1]
    Q = np.asarray(Q).T
    return W + (Q.reshape(3, 3, *(1,) * (W.ndim - 2)) if Q.ndim == 2 else Q)


def moved(x: Array, motion: Motion, U: Array) -> Array:
    """Where such a motion leads after each of N inputs : (N, …, 3)"""
    # seen from where each step begins; time last, as is fastest
    along, aside, turn = motion.f(np.zeros_like(x), U).T
    start = x.T[..., None]
    θ = wrap(start[2] + np.cumsum(turn, axis=-1))
    before = np.concatenate([start[2], θ[..., :-1]], axis=-1)[..., : θ.shape[-1]]
    c, s = np.cos(before), np.sin(before)
    way = np.cumsum([c * along - s * aside, s * along + c * aside], axis=-1)
    return np.stack([start[0] + way[0], start[1] + way[1], θ]).T


def _sheared(P: Array, way: Array) -> Array:
    """A(p) P A(p)ᵀ : (3, 3, …, N), in place; the uncertainty of a heading, seen a way p : (2, …, N)
    further.
    """
    c = np.stack([-way[1], way[0]])
    P[:2] += c[:, None] * P[2:]
    P[:, :2] += c * P[:, 2:]
    return P
