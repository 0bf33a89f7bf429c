"""What a reading leaves of a covariance, by its square root: Carlson's update, without a matrix turned round.

P is carried as P = L Lᵀ. A sum of squares has no negative variance and no correlation beyond 1, and what a sharp sensor
leaves of a wide prior, R of it, is a product here, not the difference of two numbers that agree in all their digits.
"""

import math
from operator import mul
from typing import NamedTuple

import numpy as np

from ekfsim.filters.algebra import ROUNDING, symmetric
from ekfsim.geometry import Array
from ekfsim.geometry.lanes import back, front

Rows = list[list[float]]


class Conditioned(NamedTuple):
    """What k numbers, one after the other, tell of a state."""

    root: Array  # L of the posterior, P = L Lᵀ : (…, n, n)
    K: Array  # (…, n, k)
    unmixed: Array  # T : (…, k, k), lower triangular; e = T ν are innovations that have nothing in common
    variances: Array  # of e : (…, k), S = T⁻¹ diag(s) T⁻ᵀ; 0 where nothing was uncertain

    def nis(self, innovation: Array) -> Array:
        """νᵀ S⁻¹ ν = Σ eᵢ²/sᵢ : (…), nan where S = 0 or nothing was measured or predicted"""
        e, s = np.matvec(self.unmixed, innovation), self.variances
        square = np.sum(np.divide(e * e, s, out=np.zeros(np.broadcast_shapes(e.shape, s.shape)), where=s > 0), axis=-1)
        known = np.any(s > 0, axis=-1) & ~np.isnan(innovation).any(axis=-1) & ~np.isnan(s).any(axis=-1)
        return np.where(known, square, np.nan)

    def S(self, D: Array, R: Array) -> Array:
        """D Dᵀ + R : (…, k, k), 0 where nothing was uncertain"""
        if D.shape[-2] == 1:
            return self.variances[..., None]
        D = front(D)
        S = covariance(back((D[:, None] * D[None]).sum(axis=2)) + R)
        return np.where(np.any(self.variances != 0, axis=-1)[..., None, None], S, 0.0)


def covariance(P: Array) -> Array:
    """P as a covariance must be, where rounding alone has made it none : (…, n, n)

    Symmetric, no variance below 0, no correlation beyond ±1. The one place where that is forced.
    """
    P = symmetric(P)
    if P.ndim == 2 and _is_covariance(P.tolist()):
        return P
    variances = np.diagonal(P, axis1=-2, axis2=-1)
    square = variances[..., :, None] * variances[..., None, :]
    if (square >= P * P).all() and (variances >= 0).all():
        return P
    σ = np.sqrt(np.maximum(variances, 0.0))
    limit = σ[..., :, None] * σ[..., None, :]
    return np.clip(P, -limit, limit)


def _is_covariance(P: Rows) -> bool:
    """Whether one symmetric matrix needs no force."""
    for i, row in enumerate(P):
        variance = row[i]
        if not variance >= 0:
            return False
        for j in range(i):
            if row[j] * row[j] > variance * P[j][j]:
                return False
    return True


def square_root(P: Array, seen: Array | None = None) -> Array:
    """L : (…, n, n) with P = L Lᵀ, Cholesky's, a column being zero where nothing is left to explain.

    Lower triangular, or with its rows in an order of their own, by how much of each state a reading sees: what is
    seen most is explained first. Then no small variance is left over from the difference of large ones. seen : (…, n)
    P is often singular: it starts at 0, and a straight move adds no heading noise.
    """
    if seen is not None:
        order = np.argsort(-seen * np.diagonal(P, axis1=-2, axis2=-1), axis=-1, kind="stable")
        runs = tuple(i[..., None, None] for i in np.ix_(*map(np.arange, order.shape[:-1])))
        rows, P = order[..., :, None], np.broadcast_to(P, (*order.shape, P.shape[-1]))
        L = np.empty(P.shape)
        L[(*runs, rows, np.arange(P.shape[-1]))] = square_root(P[(*runs, rows, order[..., None, :])])
        return L
    P = front(P)
    L = np.zeros(P.shape)
    for j in range(len(P)):
        rest = P[j:, j].copy()
        for m in range(j):
            rest -= L[j:, m] * L[j, m]
        pivot = rest[0]
        left = pivot > ROUNDING * P[j, j]
        L[j:, j] = rest * np.divide(1.0, np.sqrt(np.where(left, pivot, 1.0)), out=np.zeros(left.shape), where=left)
    return back(L)


def slope(H: Array, L: Array) -> Array:
    """D = H L : (…, k, n), the reading's change along the columns of L"""
    axes = np.broadcast_shapes(H.shape[:-2], L.shape[:-2])
    terms = _widened(front(H), axes, 2)[:, :, None] * _widened(front(L), axes, 2)
    D, sizes = terms.sum(axis=1), np.abs(terms).sum(axis=1)
    D[np.abs(D) <= ROUNDING * sizes] = 0.0
    return back(D)


def conditioned(L: Array, D: Array, R: Array, h: Array) -> Conditioned:
    """P⁻ = L Lᵀ and a reading of k numbers, S = D Dᵀ + R      K = L Dᵀ S⁻¹      P = L (I + Dᵀ R⁻¹ D)⁻¹ Lᵀ

    L : (…, n, n), D : (…, k, n), R : (…, k, k), h : (…, k), the reading that is predicted. One number is taken after
    the other: from the later ones is taken what they have in common with it, in the noise and in the belief. A number
    whose deviation is below the rounding of h itself tells nothing.

    Carlson, Fast triangular formulation of the square root filter, AIAA Journal, 1973.
    """
    if L.ndim == D.ndim == R.ndim == 2 and h.ndim == 1:
        told = conditioned_one(L.tolist(), D.tolist(), R.tolist(), h.tolist())
        return Conditioned(*map(np.array, told))
    n, k = L.shape[-1], D.shape[-2]
    axes = np.broadcast_shapes(L.shape[:-2], D.shape[:-2], R.shape[:-2], h.shape[:-1])
    A = np.empty((n + k, n, *axes))
    A[:n], A[n:] = _widened(front(L), axes, 2), _widened(front(D), axes, 2)
    R, h = np.array(np.broadcast_to(_widened(front(R), axes, 2), (k, k, *axes))), _widened(front(h, 1), axes, 1)
    T, K, s = np.zeros((k, k, *axes)), np.zeros((n, k, *axes)), np.zeros((k, *axes))
    for i in range(k):
        T[i, i] = 1.0
    for i in range(k):
        r, f = R[i, i], A[n + i]
        for m in range(i + 1, k):
            common = _share(R[m, i], r)
            A[n + m] -= common * f
            T[m] -= common * T[i]
            R[m] -= common * R[i]
        left, b, s_i = _carlson(A, f, r)
        nothing = s_i <= np.square(ROUNDING * h[i])
        if nothing.any():
            left, s_i = np.where(nothing, A, left), np.where(nothing, 0.0, s_i)
        A, s[i], gain = left, s_i, _share(b, s_i)
        K += gain[:n, None] * T[i]
        for m in range(i + 1, k):
            T[m] -= gain[n + m] * T[i]
    return Conditioned(back(A[:n]), back(K), back(T), back(s, 1))


def squared(L: Array, before: Array) -> Array:
    """L Lᵀ : (…, n, n), no variance larger than it was before, not even by rounding."""
    L = front(L)
    P = back((L[:, None] * L[None]).sum(axis=2))
    i = np.arange(P.shape[-1])
    P[..., i, i] = np.minimum(P[..., i, i], before[..., i, i])
    return P


def _widened(M: Array, axes: tuple[int, ...], inner: int) -> Array:
    """Entries in front, (n, m, …), with as many runs behind them as the others have."""
    return M.reshape(M.shape[:inner] + (1,) * (len(axes) + inner - M.ndim) + M.shape[inner:])


def _share(part: Array, whole: Array) -> Array:
    """part / whole, 0 where the whole is none."""
    some = whole > 0
    shares: Array = part * np.divide(1.0, whole, out=np.zeros(whole.shape), where=some)
    return shares if some.all() else np.where(some, shares, 0.0)


def _carlson(A: Array, f: Array, r: Array) -> tuple[Array, Array, Array]:
    """A (I − fᵀ f/s)^½      b = A fᵀ      s = f fᵀ + r          entries in front: A : (m, n, …), f : (n, …), r : (…)

    From the last column to the first, α being r and the squares of f so far, b the sum of f A so far.
    """
    left, α, b = np.empty(A.shape), r, np.zeros((len(A), *A.shape[2:]))
    for j in reversed(range(len(f))):
        more, noisy = α + f[j] * f[j], α > 0
        per = np.divide(1.0, more, out=np.zeros(more.shape), where=noisy)
        kept = np.sqrt(α * per)
        turned = f[j] * np.divide(per, kept, out=np.zeros(more.shape), where=noisy)
        if not noisy.all():
            kept[~(noisy | (more > 0))] = 1.0
        kept_a, turned_b = kept * A[:, j], turned * b
        rest = np.subtract(kept_a, turned_b, out=left[:, j])
        rest[np.abs(rest) <= ROUNDING * np.abs(kept_a)] = 0.0
        b += f[j] * A[:, j]
        α = more
    return left, b, α


def square_root_one(P: Rows, H: Rows) -> Rows:
    """`square_root` of one robot in plain floats, held equal to it by a test."""
    n = len(P)
    seen = [-sum([row[i] * row[i] for row in H]) * P[i][i] for i in range(n)]
    order = sorted(range(n), key=seen.__getitem__)
    L = [[0.0] * n for _ in range(n)]
    for j, p in enumerate(order):
        P_p, L_p = P[p], L[p]
        pivot = P_p[p]
        for m in range(j):
            pivot -= L_p[m] * L_p[m]
        if pivot > ROUNDING * P_p[p]:
            L_p[j] = root = math.sqrt(pivot)
            for q in order[j + 1 :]:
                L_q, rest = L[q], P_p[q]
                for m in range(j):
                    rest -= L_q[m] * L_p[m]
                L_q[j] = rest / root
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


def conditioned_one(L: Rows, D: Rows, R: Rows, h: list[float]) -> tuple[Rows, Rows, Rows, list[float]]:
    """`conditioned` of one robot: the root of P, K, T and s."""
    n, k = len(L), len(D)
    if k == 1:
        left, b, s_1 = _carlson_one(L, D[0], R[0][0])
        if s_1 <= (ROUNDING * h[0]) ** 2:
            return L, [[0.0]] * n, [[1.0]], [0.0]
        return left, [[b_q / s_1 if s_1 > 0 else 0.0] for b_q in b], [[1.0]], [s_1]
    A, R = [*map(list, L), *map(list, D)], [*map(list, R)]
    T, s, K = [[float(i == j) for j in range(k)] for i in range(k)], [0.0] * k, [[0.0] * k for _ in range(n)]
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
                for m in range(i + 1):
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
