"""arithmetic/square_root.py of one robot."""

import math
from operator import mul

import numpy as np

from ekfsim.filters.arithmetic.square_root import Conditioned
from ekfsim.filters.arithmetic.tolerances import ROUNDING
from ekfsim.geometry import Array

Rows = list[list[float]]


def covariance(P: Array) -> Array | None:
    """The symmetric part where that is a covariance, as it mostly is."""
    if P.ndim != 2:
        return None
    P = 0.5 * (P + P.T)
    return P if is_covariance_one(P.tolist()) else None


def square_root(P: Array, seen: Array | None = None) -> Array | None:
    """L, its rows in an order of their own where it is told what is seen."""
    if P.ndim != 2 or (seen is not None and seen.ndim != 1):
        return None
    rows = P.tolist()
    order = list(range(len(rows)))
    if seen is not None:
        weights = [-s * rows[i][i] for i, s in enumerate(seen.tolist())]
        order.sort(key=weights.__getitem__)
    return np.array(_cholesky_one(rows, order))


def slope(H: Array, L: Array) -> Array | None:
    """D = H L"""
    if H.ndim != 2 or L.ndim != 2:
        return None
    return np.array(slope_one(H.tolist(), L.tolist()))


def conditioned(L: Array, D: Array, R: Array, h: Array) -> Conditioned | None:
    """The root of P, K, T and s."""
    if not L.ndim == D.ndim == R.ndim == 2 or h.ndim != 1:
        return None
    told = conditioned_one(L.tolist(), D.tolist(), R.tolist(), h.tolist())
    return Conditioned(*map(np.array, told))


def is_covariance_one(P: Rows) -> bool:
    """Whether one symmetric matrix needs no force."""
    for i, row in enumerate(P):
        variance = row[i]
        if not variance >= 0:
            return False
        for j in range(i):
            if row[j] * row[j] > variance * P[j][j]:
                return False
    return True


def square_root_one(P: Rows, H: Rows) -> Rows:
    """The root of P, its rows in the order in which a reading of Jacobian H sees them."""
    n = len(P)
    seen = [-sum([row[i] * row[i] for row in H]) * P[i][i] for i in range(n)]
    return _cholesky_one(P, sorted(range(n), key=seen.__getitem__))


def _cholesky_one(P: Rows, order: list[int]) -> Rows:
    n = len(P)
    L = [[0.0] * n for _ in range(n)]
    for j, p in enumerate(order):
        P_p, L_p = P[p], L[p]
        pivot = P_p[p]
        for m in range(j):
            pivot -= L_p[m] * L_p[m]
        if pivot > ROUNDING * P_p[p]:
            per_root = 1.0 / math.sqrt(pivot)
            L_p[j] = pivot * per_root
            for q in order[j + 1 :]:
                L_q, rest = L[q], P_p[q]
                for m in range(j):
                    rest -= L_q[m] * L_p[m]
                L_q[j] = rest * per_root
    return L


def slope_one(H: Rows, L: Rows) -> Rows:
    """`slope` of one robot."""
    n, D = len(L), []
    for row in H:
        f = []
        for j in range(n):
            d = terms = 0.0
            for h, L_i in zip(row, L, strict=True):
                term = h * L_i[j]
                d += term
                terms += abs(term)
            f.append(d if abs(d) > ROUNDING * terms else 0.0)
        D.append(f)
    return D


def conditioned_one(
    L: Rows, D: Rows, R: Rows, h: list[float]
) -> tuple[Rows, Rows, Rows, list[float]]:
    """`conditioned` of one robot: the root of P, K, T and s."""
    n, k = len(L), len(D)
    if k == 1:
        left, b, s_1 = _carlson_one(L, D[0], R[0][0])
        if s_1 <= (ROUNDING * h[0]) ** 2:
            return L, [[0.0]] * n, [[1.0]], [0.0]
        return left, [[b_q / s_1 if s_1 > 0 else 0.0] for b_q in b], [[1.0]], [s_1]
    order = list(range(k))
    if any(R[i][m] for i in order for m in range(i)):
        known = [sum(map(mul, f, f)) for f in D]
        order.sort(key=lambda i: -R[i][i] / known[i] if known[i] > 0 else -math.inf)
    A, R, h = (
        [*map(list, L), *(list(D[i]) for i in order)],
        [[R[i][m] for m in order] for i in order],
        [h[i] for i in order],
    )
    T, s, K = (
        [[float(i == j) for j in range(k)] for i in order],
        [0.0] * k,
        [[0.0] * k for _ in range(n)],
    )
    for i in range(k):
        f, r, T_i = A[n + i], R[i][i], T[i]
        for m in range(i + 1, k):
            if r > 0 and R[m][i]:
                common = R[m][i] / r
                A[n + m] = [a - common * f_j for a, f_j in zip(A[n + m], f, strict=True)]
                T[m] = [t - common * t_i for t, t_i in zip(T[m], T_i, strict=True)]
                R[m] = [x - common * y for x, y in zip(R[m], R[i], strict=True)]
        left, b, s_i = _carlson_one(A, f, r)
        if s_i <= (ROUNDING * h[i]) ** 2:
            continue
        A, s[i] = left, s_i
        if s_i > 0:
            for row, b_q in zip(K, b, strict=False):
                share = b_q / s_i
                for m in range(k):
                    row[m] += share * T_i[m]
            for m in range(i + 1, k):
                share = b[n + m] / s_i
                T[m] = [t - share * t_i for t, t_i in zip(T[m], T_i, strict=True)]
    return A[:n], K, T, s


def _carlson_one(A: Rows, f: list[float], r: float) -> tuple[Rows, list[float], float]:
    """`_carlson` of one robot."""
    α, turns = r, []
    for f_j in reversed(f):
        more = α + f_j * f_j
        if α > 0:
            turns.append((f_j, math.sqrt(α / more), f_j / math.sqrt(α * more)))
        else:
            turns.append((f_j, 0.0 if more > 0 else 1.0, 0.0))
        α = more
    left, sums, last = [], [], len(f) - 1
    for row in A:
        new, b, j = [0.0] * len(f), 0.0, last
        for f_j, kept, turned in turns:
            a = row[j]
            kept_a, turned_b = kept * a, turned * b
            rest = kept_a - turned_b
            new[j] = rest if abs(rest) > ROUNDING * abs(kept_a) else 0.0
            b += f_j * a
            j -= 1
        left.append(new)
        sums.append(b)
    return left, sums, α


def nis_one(T: Rows, s: list[float], innovation: list[float]) -> float:
    """`Conditioned.nis` of one robot."""
    if len(s) == 1:
        return innovation[0] * innovation[0] / s[0] if s[0] > 0 else math.nan
    if not any(s) or any(map(math.isnan, s)):
        return math.nan
    e: list[float] = [sum(map(mul, row, innovation)) for row in T]
    return sum(e_i * e_i / s_i for e_i, s_i in zip(e, s, strict=True) if s_i > 0)


def squared_one(L: Rows, before: Rows) -> Rows:
    """`squared` of one robot."""
    n = len(L)
    P = [[0.0] * n for _ in range(n)]
    for i, row in enumerate(L):
        P[i][i] = min(sum(map(mul, row, row)), before[i][i])
        for j in range(i):
            P[i][j] = P[j][i] = sum(map(mul, row, L[j]))
    return P
