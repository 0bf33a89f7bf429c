"""What a reading leaves of a covariance, by its square root: Carlson's update, without a matrix
turned round.

P is carried as P = L Lᵀ. A sum of squares has no negative variance and no correlation beyond 1, and
what a sharp sensor leaves of a wide prior, R of it, is a product here, not the difference of two
numbers that agree in all their digits.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.filters.algebra import ROUNDING, symmetric
from ekfsim.filters.conditioning_one import conditioned_one, is_covariance_one
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.soa import back, front


class Conditioned(NamedTuple):
    """What k numbers, one after the other, tell of a state."""

    root: Array  # L of the posterior, P = L Lᵀ : (…, n, n)
    K: Array  # (…, n, k)
    unmixed: Array  # T : (…, k, k); e = T ν are innovations that have nothing in common
    variances: Array  # of e : (…, k), S = T⁻¹ diag(s) T⁻ᵀ; 0 where nothing was uncertain

    def nis(self, innovation: Array) -> Array:
        """νᵀ S⁻¹ ν = Σ eᵢ²/sᵢ : (…), nan where S = 0 or nothing was measured or predicted"""
        e, s = np.matvec(self.unmixed, innovation), self.variances
        square = np.sum(
            np.divide(e * e, s, out=np.zeros(np.broadcast_shapes(e.shape, s.shape)), where=s > 0),
            axis=-1,
        )
        known = (
            np.any(s > 0, axis=-1) & ~np.isnan(innovation).any(axis=-1) & ~np.isnan(s).any(axis=-1)
        )
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
    if P.ndim == 2 and is_covariance_one(P.tolist()):
        return P
    variances = np.diagonal(P, axis1=-2, axis2=-1)
    square = variances[..., :, None] * variances[..., None, :]
    if (square >= P * P).all() and (variances >= 0).all():
        return P
    σ = np.sqrt(np.maximum(variances, 0.0))
    limit = σ[..., :, None] * σ[..., None, :]
    return np.clip(P, -limit, limit)


def square_root(P: Array, seen: Array | None = None) -> Array:
    """L : (…, n, n) with P = L Lᵀ, Cholesky's, a column being zero where nothing is left to
    explain.

    Lower triangular, or with its rows in an order of their own, by how much of each state a reading
    sees: what is seen most is explained first. Then no small variance is left over from the
    difference of large ones. seen : (…, n) P is often singular: it starts at 0, and a straight move
    adds no heading noise.
    """
    if seen is not None:
        order = np.argsort(-seen * np.diagonal(P, axis1=-2, axis2=-1), axis=-1, kind="stable")
        runs = tuple(i[..., None, None] for i in np.ix_(*map(np.arange, order.shape[:-1])))
        rows, P = order[..., :, None], np.broadcast_to(P, (*order.shape, P.shape[-1]))
        L = np.empty(P.shape)
        L[(*runs, rows, np.arange(P.shape[-1]))] = square_root(
            P[(*runs, rows, order[..., None, :])]
        )
        return L
    P = front(P)
    L = np.zeros(P.shape)
    for j in range(len(P)):
        rest = P[j:, j].copy()
        for m in range(j):
            rest -= L[j:, m] * L[j, m]
        pivot = rest[0]
        left = pivot > ROUNDING * P[j, j]
        L[j:, j] = rest * np.divide(
            1.0, np.sqrt(np.where(left, pivot, 1.0)), out=np.zeros(left.shape), where=left
        )
    return back(L)


def slope(H: Array, L: Array) -> Array:
    """D = H L : (…, k, n), the reading's change along the columns of L"""
    axes = np.broadcast_shapes(H.shape[:-2], L.shape[:-2])
    terms = _widened(front(H), axes, 2)[:, :, None] * _widened(front(L), axes, 2)
    D, sizes = terms.sum(axis=1), np.abs(terms).sum(axis=1)
    D[np.abs(D) <= ROUNDING * sizes] = 0.0
    return back(D)


def conditioned(L: Array, D: Array, R: Array, h: Array) -> Conditioned:
    """P⁻ = L Lᵀ and a reading of k numbers, S = D Dᵀ + R      K = L Dᵀ S⁻¹
    P = L (I + Dᵀ R⁻¹ D)⁻¹ Lᵀ

    L : (…, n, n), D : (…, k, n), R : (…, k, k), h : (…, k), the reading that is predicted. One
    number is taken after the other, the dullest first where their noises have something in common:
    from the later ones is taken what they have in common with it, in the noise and in the belief. A
    number whose deviation is below the rounding of h itself tells nothing.

    Carlson, Fast triangular formulation of the square root filter, AIAA Journal, 1973.
    """
    if L.ndim == D.ndim == R.ndim == 2 and h.ndim == 1:
        told = conditioned_one(L.tolist(), D.tolist(), R.tolist(), h.tolist())
        return Conditioned(*map(np.array, told))
    n, k = L.shape[-1], D.shape[-2]
    axes = np.broadcast_shapes(L.shape[:-2], D.shape[:-2], R.shape[:-2], h.shape[:-1])
    A = np.empty((n + k, n, *axes))
    A[:n], A[n:] = _widened(front(L), axes, 2), _widened(front(D), axes, 2)
    R, h = (
        np.array(np.broadcast_to(_widened(front(R), axes, 2), (k, k, *axes))),
        _widened(front(h, 1), axes, 1),
    )
    T, K, s = np.zeros((k, k, *axes)), np.zeros((n, k, *axes)), np.zeros((k, *axes))
    for i in range(k):
        T[i, i] = 1.0
    if any(R[i, m].any() for i in range(k) for m in range(i)):
        dullest = np.argsort(-_dullness(R, A[n:]), axis=0, kind="stable")
        A[n:], T, R, h = (
            np.take_along_axis(M, _rows_of(dullest, M), axis=0) for M in (A[n:], T, R, h)
        )
        R = np.take_along_axis(R, dullest[None], axis=1)
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


def _dullness(R: Array, D: Array) -> Array:
    """How much noisier than the belief each number is : (k, …), ∞ where that knows it. R : (k, k,
    …), D : (k, n, …)
    """
    known = np.sum(np.square(D), axis=1)
    dullness: Array = np.divide(
        np.einsum("ii...->i...", R), known, out=np.full(known.shape, np.inf), where=known > 0
    )
    return dullness


def _rows_of(order: Integers, M: Array) -> Integers:
    """An order of rows : (k, …) as wide as those of M : (k, m, …) are."""
    return order if M.ndim == order.ndim else order[:, None]


def _share(part: Array, whole: Array) -> Array:
    """part / whole, 0 where the whole is none."""
    some = whole > 0
    shares: Array = part * np.divide(1.0, whole, out=np.zeros(whole.shape), where=some)
    return shares if some.all() else np.where(some, shares, 0.0)


def _carlson(A: Array, f: Array, r: Array) -> tuple[Array, Array, Array]:
    """A (I − fᵀ f/s)^½      b = A fᵀ      s = f fᵀ + r
    entries in front: A : (m, n, …), f : (n, …), r : (…)

    From the last column to the first, α being r and the squares of f so far, b the sum of f A so
    far.
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
