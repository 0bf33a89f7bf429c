"""What unrolled.py does, and the NEES, compiled by Numba: the extra `fast`.

Imported only where twins.py has been told to take it. All arrays have their entries in
front and the runs behind, (3, 3, N), one stretch of memory. Most loops are short on purpose: then
several runs are taken at once.
"""

import numpy as np

from ekfsim.geometry import Array, Booleans
from ekfsim.twins import compiled


def propagated(P: Array, F: Array, G: Array, M: Array) -> Array | None:
    """F P Fᵀ + G M Gᵀ : (3, 3, N); None where F or M are not such as unrolled.py knows"""
    new = np.empty(P.shape)
    P, F, G, M = (np.ascontiguousarray(each) for each in (P, F, G, M))
    return new if _propagate(P, F, G, M, new) else None


def revised(
    x: Array, P: Array, H: Array, r: Array, ν: Array, sharp: float
) -> tuple[Array, Array, Array, Array, Array, Booleans]:
    """S, K, x, P and NIS as in unrolled.py, and for which runs they may be trusted."""
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


def squares(e: Array, P: Array, tiny: float, sure: float) -> tuple[Array, Booleans]:
    """eᵀ P⁻¹ e of three entries : (N,), and where P is clearly of full rank, as in
    fast/nees.py
    """
    value, clear = np.empty(e.shape[1:]), np.empty(e.shape[1:], bool)
    _square(np.ascontiguousarray(e), np.ascontiguousarray(P), tiny, sure, value, clear)
    return value, clear


@compiled
def _propagate(P: Array, F: Array, G: Array, M: Array, new: Array) -> bool:
    """F P Fᵀ + G M Gᵀ into `new`, and whether F and M are such as unrolled.py knows."""
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


@compiled
def _square(e: Array, P: Array, tiny: float, sure: float, value: Array, clear: Booleans) -> None:
    """The same, by P = L D Lᵀ."""
    for n in range(e.shape[1]):
        a, b, d = P[0, 0, n], P[0, 1, n], P[1, 1, n]
        p, q, r = P[2, 0, n], P[2, 1, n], P[2, 2, n]
        k = b / a
        D = d - k * b
        y = e[1, n] - k * e[0, n]
        m = p / a
        c = q - m * b
        o = c / D
        D3 = r - m * p - o * c
        y3 = e[2, n] - m * e[0, n] - o * y
        value[n] = e[0, n] * e[0, n] / a + y * y / D + y3 * y3 / D3
        clear[n] = (a > tiny) & (d > tiny) & (r > tiny) & (sure * d < D) & (sure * d * r < D * D3)
