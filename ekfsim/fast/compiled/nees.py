"""many/nees.py, compiled."""

import numpy as np

from ekfsim.diagnostics.nees import ROUNDING
from ekfsim.fast.many.nees import CLEAR, judged
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.twins import compiled


def squared_mahalanobis(e: Array, P: Array) -> tuple[Array, Integers, Booleans] | None:
    """eᵀ P⁺ e of many runs in three dimensions."""
    return judged(e, P, full_rank) if e.shape[-1] == 3 else None


def full_rank(e: Array, P: Array) -> tuple[Array, Booleans]:
    """eᵀ P⁻¹ e : (N,), and where P is clearly of full rank; e : (3, N), P : (3, 3, N)"""
    value, clear = np.empty(e.shape[1:]), np.empty(e.shape[1:], bool)
    _square(np.ascontiguousarray(e), np.ascontiguousarray(P), ROUNDING**2, CLEAR, value, clear)
    return value, clear


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
