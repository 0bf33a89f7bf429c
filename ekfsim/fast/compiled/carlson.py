"""What a sharp sensor leaves of one covariance, compiled by Numba: the twin of conditioning.py.

P : (6, N) is the upper half of each run's covariance, row after row.
"""

import math

import numpy as np

from ekfsim.fast.compiled.angles import wrapped
from ekfsim.geometry import Array
from ekfsim.twins import compiled


@compiled
def carlson(
    x: Array, P: Array, n: int, H: Array, R: float, h: float, ν: float, gate: float,
    rounding: float, L: Array,
) -> float:  # fmt: skip
    """Revise x and P of run n by a reading of z = h + ν, and tell its NIS; nan where S = 0.

    H : (3,); L : (3, 3), room for the square root
    """
    _square_root(P, n, H, L, rounding)
    b0 = b1 = b2 = 0.0  # L Dᵀ so far
    s = R  # and R + D Dᵀ
    D = H[0] * L[0] + H[1] * L[1] + H[2] * L[2]
    for j in range(2, -1, -1):
        a0, a1, a2 = L[0, j], L[1, j], L[2, j]
        size = abs(H[0] * a0) + abs(H[1] * a1) + abs(H[2] * a2)
        f = D[j] if abs(D[j]) > rounding * size else 0.0
        more = s + f * f
        kept = math.sqrt(s / more) if more > 0 else 1.0
        turned = f / (more * kept) if s > 0 else 0.0
        L[0, j] = _rest(kept * a0, turned * b0, rounding)
        L[1, j] = _rest(kept * a1, turned * b1, rounding)
        L[2, j] = _rest(kept * a2, turned * b2, rounding)
        b0, b1, b2, s = b0 + f * a0, b1 + f * a1, b2 + f * a2, more
    if s <= (rounding * h) ** 2:
        return math.nan
    nis = ν * ν / s
    if nis > gate:
        return nis
    P[0, n] = min(_dot(L, 0, 0), P[0, n])
    P[3, n] = min(_dot(L, 1, 1), P[3, n])
    P[5, n] = min(_dot(L, 2, 2), P[5, n])
    P[1, n], P[2, n], P[4, n] = _dot(L, 0, 1), _dot(L, 0, 2), _dot(L, 1, 2)
    x[0, n] += b0 / s * ν
    x[1, n] += b1 / s * ν
    x[2, n] = wrapped(x[2, n] + b2 / s * ν)
    return nis


@compiled
def _square_root(P: Array, n: int, H: Array, L: Array, rounding: float) -> None:
    """L, its rows explained in the order of how much of them the reading sees: `square_root`."""
    whole = np.array(
        [[P[0, n], P[1, n], P[2, n]], [P[1, n], P[3, n], P[4, n]], [P[2, n], P[4, n], P[5, n]]]
    )
    sees = np.array([H[0] * H[0] * P[0, n], H[1] * H[1] * P[3, n], H[2] * H[2] * P[5, n]])
    order = np.argsort(-sees, kind="mergesort")
    L[:] = 0.0
    for j in range(3):
        pivot = whole[order[j], order[j]]
        for m in range(j):
            pivot -= L[order[j], m] * L[order[j], m]
        if not pivot > rounding * whole[order[j], order[j]]:
            continue
        for i in range(j, 3):
            rest = whole[order[i], order[j]]
            for m in range(j):
                rest -= L[order[i], m] * L[order[j], m]
            L[order[i], j] = rest / math.sqrt(pivot)


@compiled
def _rest(kept: float, turned: float, rounding: float) -> float:
    """Their difference, 0 where that is rounding."""
    rest = kept - turned
    return rest if abs(rest) > rounding * abs(kept) else 0.0


@compiled
def _dot(L: Array, i: int, j: int) -> float:
    """An entry of L Lᵀ."""
    entry: float = L[i, 0] * L[j, 0] + L[i, 1] * L[j, 1] + L[i, 2] * L[j, 2]
    return entry
