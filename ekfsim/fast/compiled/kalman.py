"""many/kalman.py, compiled."""

import numpy as np

from ekfsim.fast.many.kalman import predicted, updated
from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.filters.kalman import Linearized, Rule
from ekfsim.geometry import Array, Booleans
from ekfsim.twins import compiled


def predict(P: Array, F: Array, G: Array, M: Array, Q: Array | float) -> Array | None:
    """F P Fᵀ + G M Gᵀ + Q : (N, 3, 3), exactly symmetric"""
    return predicted(P, F, G, M, Q, propagated, sound)


def update(prior: Gaussian, reading: Linearized, rule: Rule) -> tuple[Gaussian, Correction] | None:
    """K = P⁻ Hᵀ/S      x = x⁻ + K ν      P = P⁻ − P⁻ Hᵀ H P⁻/S          of one number in N runs"""
    return updated(prior, reading, rule, revised, sound)


def propagated(P: Array, F: Array, G: Array, M: Array) -> Array | None:
    """F P Fᵀ + G M Gᵀ : (3, 3, N); None where F or M are not such as many/kalman.py knows"""
    new = np.empty(P.shape)
    P, F, G, M = (np.ascontiguousarray(each) for each in (P, F, G, M))
    return new if _propagate(P, F, G, M, new) else None


def revised(
    x: Array, P: Array, H: Array, r: Array, ν: Array, sharp: float
) -> tuple[Array, Array, Array, Array, Array, Booleans]:
    """S, K, x, P and NIS as there, and for which runs they may be trusted."""
    new = (
        np.empty(r.shape),
        np.empty(x.shape),
        np.empty(x.shape),
        np.empty(P.shape),
        np.empty(r.shape),
    )
    clear = np.empty(r.shape, bool)
    x, P, H, r, ν = (np.ascontiguousarray(each) for each in (x, P, H, r, ν))
    _revise(x, P, H, r, ν, sharp, *new, clear)
    return *new, clear


def sound(P: Array) -> bool:
    """Whether no variance is negative and no correlation beyond ±1."""
    return bool(_is_sound(np.ascontiguousarray(P)))


@compiled
def _propagate(P: Array, F: Array, G: Array, M: Array, new: Array) -> bool:
    """F P Fᵀ + G M Gᵀ into `new`, and whether F and M are such as many/kalman.py knows."""
    m, N = M.shape[0], P.shape[2]
    strange = 0
    for n in range(N):
        strange += (F[0, 0, n] != 1) | (F[1, 1, n] != 1) | (F[2, 2, n] != 1)
        strange += (F[0, 1, n] != 0) | (F[1, 0, n] != 0) | (F[2, 0, n] != 0) | (F[2, 1, n] != 0)
    for k in range(m):
        for i in range(m):
            if i != k:
                for n in range(N):
                    strange += M[k, i, n] != 0
    if strange:
        return False
    α, β = F[0, 2], F[1, 2]
    for n in range(N):
        new[0, 2, n] = P[0, 2, n] + α[n] * P[2, 2, n]
        new[1, 2, n] = P[1, 2, n] + β[n] * P[2, 2, n]
    for n in range(N):
        new[0, 0, n] = P[0, 0, n] + α[n] * (P[0, 2, n] + new[0, 2, n])
    for n in range(N):
        new[0, 1, n] = P[0, 1, n] + β[n] * P[0, 2, n] + α[n] * new[1, 2, n]
    for n in range(N):
        new[1, 1, n] = P[1, 1, n] + β[n] * (P[1, 2, n] + new[1, 2, n])
        new[2, 2, n] = P[2, 2, n]
    for k in range(m):
        for i in range(3):
            for j in range(i, 3):
                for n in range(N):
                    new[i, j, n] += G[i, k, n] * M[k, k, n] * G[j, k, n]
    for i in range(3):
        for j in range(i):
            new[i, j] = new[j, i]
    return True


@compiled
def _revise(
    x: Array, P: Array, H: Array, r: Array, ν: Array, sharp: float,
    s: Array, K: Array, mean: Array, covariance: Array, nis: Array, clear: Booleans,
) -> None:  # fmt: skip
    """The same, line by line; K holds P Hᵀ, and NIS 1/S, as long as they are needed."""
    N = x.shape[1]
    for i in range(3):
        for n in range(N):
            K[i, n] = P[i, 0, n] * H[0, n] + P[i, 1, n] * H[1, n] + P[i, 2, n] * H[2, n]
    for n in range(N):
        s[n] = H[0, n] * K[0, n] + H[1, n] * K[1, n] + H[2, n] * K[2, n]
    for n in range(N):
        terms = (
            H[0, n] * H[0, n] * P[0, 0, n]
            + H[1, n] * H[1, n] * P[1, 1, n]
            + H[2, n] * H[2, n] * P[2, 2, n]
        )
        clear[n] = (r[n] > sharp * terms) & (ν[n] == ν[n])
    for n in range(N):
        s[n] += r[n]
        nis[n] = 1 / s[n]
    for i in range(3):
        for j in range(i, 3):
            for n in range(N):
                covariance[i, j, n] = P[i, j, n] - K[i, n] * K[j, n] * nis[n]
        for j in range(i):
            covariance[i, j] = covariance[j, i]
    for i in range(3):
        for n in range(N):
            K[i, n] *= nis[n]
            mean[i, n] = x[i, n] + K[i, n] * ν[n]
    for n in range(N):
        nis[n] *= ν[n] * ν[n]


@compiled
def _is_sound(P: Array) -> bool:
    """The same, counted without a branch."""
    beyond = 0
    for n in range(P.shape[2]):
        a, d, v = P[0, 0, n], P[1, 1, n], P[2, 2, n]
        b, c, e = P[0, 1, n], P[0, 2, n], P[1, 2, n]
        fine = (
            (a >= 0) & (d >= 0) & (v >= 0) & (b * b <= a * d) & (c * c <= a * v) & (e * e <= d * v)
        )
        beyond += not fine
    return beyond == 0
