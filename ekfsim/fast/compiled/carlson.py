"""What a sharp sensor leaves of one covariance, compiled by Numba: as
filters/arithmetic/square_root.py has it.

P : (6, N) is the upper half of each run's covariance, row after row.
"""

import math

from ekfsim.fast.compiled.angles import wrapped
from ekfsim.fast.compiled.trusting import weighed
from ekfsim.geometry import Array
from ekfsim.twins import compiled


@compiled
def carlson(
    x: Array, P: Array, n: int, H: Array, R: float, h: float, ν: float,
    gate: float, limit: float, ln_clutter: float, rounding: float, L: Array,
) -> float:  # fmt: skip
    """Revise x and P of run n by a reading of z = h + ν, and tell its NIS; nan where S = 0.

    H : (3,); L : (3, 3), room for the square root; limit, ln_clutter : see `weighed`
    """
    _square_root(P, n, H, L, rounding)
    H0, H1, H2 = H[0], H[1], H[2]
    b0 = b1 = b2 = 0.0  # L Dᵀ so far
    s = R  # and R + D Dᵀ
    for j in range(2, -1, -1):
        a0, a1, a2 = L[0, j], L[1, j], L[2, j]
        size = abs(H0 * a0) + abs(H1 * a1) + abs(H2 * a2)
        f = H0 * a0 + H1 * a1 + H2 * a2
        f = f if abs(f) > rounding * size else 0.0
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
    w, v = weighed(nis, s, limit, ln_clutter)
    spread = (w - v) / s
    _mix(P, n, 0, min(_dot(L, 0, 0), P[0, n]), w, spread * b0 * b0)
    _mix(P, n, 3, min(_dot(L, 1, 1), P[3, n]), w, spread * b1 * b1)
    _mix(P, n, 5, min(_dot(L, 2, 2), P[5, n]), w, spread * b2 * b2)
    _mix(P, n, 1, _dot(L, 0, 1), w, spread * b0 * b1)
    _mix(P, n, 2, _dot(L, 0, 2), w, spread * b0 * b2)
    _mix(P, n, 4, _dot(L, 1, 2), w, spread * b1 * b2)
    x[0, n] += b0 / s * w * ν
    x[1, n] += b1 / s * w * ν
    x[2, n] = wrapped(x[2, n] + b2 / s * w * ν)
    return nis


@compiled
def _mix(P: Array, n: int, k: int, after: float, w: float, more: float) -> None:
    """An entry of P where a reading that leaves `after` of it is believed to the share w."""
    P[k, n] = after if w == 1 else (1 - w) * P[k, n] + w * after + more


@compiled
def _square_root(P: Array, n: int, H: Array, L: Array, rounding: float) -> None:
    """L, its rows explained in the order of how much of them the reading sees: `square_root`."""
    sees = H[0] * H[0] * P[0, n], H[1] * H[1] * P[3, n], H[2] * H[2] * P[5, n]
    i, j, k = 0, 1, 2
    if sees[j] > sees[i]:
        i, j = j, i
    if sees[k] > sees[j]:
        j, k = k, j
    if sees[j] > sees[i]:
        i, j = j, i
    L[0, 0] = L[0, 1] = L[0, 2] = L[1, 0] = L[1, 1] = L[1, 2] = L[2, 0] = L[2, 1] = L[2, 2] = 0.0
    _explain(P, n, L, i, j, k, 0, rounding)
    _explain(P, n, L, j, k, k, 1, rounding)
    _explain(P, n, L, k, k, k, 2, rounding)


@compiled
def _explain(
    P: Array, n: int, L: Array, first: int, second: int, third: int, column: int, rounding: float
) -> None:
    """A column of L: what the ones before it leave of the first entry and of what comes after."""
    pivot = _left(P, n, L, first, first)
    if pivot > rounding * P[_place(first, first), n]:
        per_root = 1 / math.sqrt(pivot)
        L[third, column] = _left(P, n, L, third, first) * per_root
        L[second, column] = _left(P, n, L, second, first) * per_root
        L[first, column] = pivot * per_root


@compiled
def _left(P: Array, n: int, L: Array, i: int, j: int) -> float:
    """What the columns so far leave unexplained of an entry of P."""
    left: float = P[_place(i, j), n] - _dot(L, i, j)
    return left


@compiled
def _place(i: int, j: int) -> int:
    """Where P's entry (i, j) stands in its upper half: 0 1 2, 3 4, 5."""
    row, column = min(i, j), max(i, j)
    return row * (5 - row) // 2 + column


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
