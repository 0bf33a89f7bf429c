"""What a reading leaves of a covariance, by its square root: Carlson's update, without a matrix
turned round.

P is carried as P = L Lᵀ. A sum of squares has no negative variance and no correlation beyond 1, and
what a sharp sensor leaves of a wide prior, R of it, is a product here, not the difference of two
numbers that agree in all their digits.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric
from ekfsim.filters.arithmetic.tolerances import ROUNDING
from ekfsim.geometry import Array
from ekfsim.geometry.soa import soa_zeros
from ekfsim.twins import twinned


class Conditioned(NamedTuple):
    """What k numbers, one after the other, tell of a state."""

    root: Array  # L of the posterior, P = L Lᵀ : (…, n, n)
    K: Array  # (…, n, k)
    unmixed: Array  # T : (…, k, k); e = T ν are innovations that have nothing in common
    variances: Array  # of e : (…, k), S = T⁻¹ diag(s) T⁻ᵀ; 0 where nothing was uncertain

    def nis(self, innovation: Array) -> Array:
        """νᵀ S⁻¹ ν = Σ eᵢ²/sᵢ : (…), nan where S = 0 or nothing was measured or predicted"""
        e, s = np.matvec(self.unmixed, innovation), self.variances
        square = np.sum(_share(e * e, s), axis=-1)
        unknown = np.isnan(innovation).any(axis=-1) | np.isnan(s).any(axis=-1)
        return np.where(np.any(s > 0, axis=-1) & ~unknown, square, np.nan)

    def S(self, D: Array, R: Array) -> Array:
        """D Dᵀ + R : (…, k, k), 0 where nothing was uncertain"""
        uncertain = np.any(self.variances != 0, axis=-1)[..., None, None]
        if D.shape[-2] == 1:
            return self.variances[..., None]
        return np.where(uncertain, covariance(_product(D) + R), 0.0)

    def covariance(self, before: Array) -> Array:
        """L Lᵀ : (…, n, n), no variance larger than it was before, not even by rounding; all as it
        was where nothing was learnt.
        """
        P = _product(self.root)
        i = np.arange(P.shape[-1])
        P[..., i, i] = np.minimum(P[..., i, i], before[..., i, i])
        return np.where(np.any(self.variances > 0, axis=-1)[..., None, None], P, before)


@twinned
def covariance(P: Array) -> Array:
    """P as a covariance must be, where rounding alone has made it none : (…, n, n)

    Symmetric, no variance below 0, no correlation beyond ±1. The one place where that is forced.
    """
    P = symmetric(P)
    σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 0.0))
    limit = σ[..., :, None] * σ[..., None, :]
    return np.clip(P, -limit, limit)


@twinned
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
        P = np.broadcast_to(P, (*order.shape, P.shape[-1]))
        P = np.take_along_axis(P, order[..., :, None], axis=-2)
        L = square_root(np.take_along_axis(P, order[..., None, :], axis=-1))
        return np.take_along_axis(L, np.argsort(order, axis=-1)[..., :, None], axis=-2)
    n = P.shape[-1]
    L = soa_zeros(P.shape[:-2], n, n)
    for j in range(n):
        rest = P[..., j:, j]
        for m in range(j):
            rest = rest - L[..., j:, m] * L[..., j, None, m]
        pivot = rest[..., 0]
        left = pivot > ROUNDING * P[..., j, j]
        per_root = np.where(left, 1.0 / np.sqrt(np.where(left, pivot, 1.0)), 0.0)
        L[..., j:, j] = rest * per_root[..., None]
    return L


@twinned
def slope(H: Array, L: Array) -> Array:
    """D = H L : (…, k, n), the reading's change along the columns of L"""
    terms = H[..., :, :, None] * L[..., None, :, :]
    D, sizes = terms.sum(axis=-2), np.abs(terms).sum(axis=-2)
    return np.where(np.abs(D) <= ROUNDING * sizes, 0.0, D)


@twinned
def conditioned(L: Array, D: Array, R: Array, h: Array) -> Conditioned:
    """P⁻ = L Lᵀ and a reading of k numbers, S = D Dᵀ + R      K = L Dᵀ S⁻¹
    P = L (I + Dᵀ R⁻¹ D)⁻¹ Lᵀ

    L : (…, n, n), D : (…, k, n), R : (…, k, k), h : (…, k), the reading that is predicted. One
    number is taken after the other, the dullest first where their noises have something in common:
    from the later ones is taken what they have in common with it, in the noise and in the belief. A
    number whose deviation is below the rounding of h itself tells nothing.

    Carlson, Fast triangular formulation of the square root filter, AIAA Journal, 1973.
    """
    n, k = L.shape[-1], D.shape[-2]
    axes = np.broadcast_shapes(L.shape[:-2], D.shape[:-2], R.shape[:-2], h.shape[:-1])
    A, rest = soa_zeros(axes, n + k, n), soa_zeros(axes, k, k)  # rows of L, then of D; R
    A[..., :n, :], A[..., n:, :], rest[...] = L, D, R
    K, T, s = soa_zeros(axes, n, k), soa_zeros(axes, k, k), soa_zeros(axes, k)
    T[...], h = np.eye(k), np.broadcast_to(h, (*axes, k))
    if np.any(rest != rest * np.eye(k)):
        dullest = np.argsort(-_dullness(rest, A[..., n:, :]), axis=-1, kind="stable")
        rows = dullest[..., :, None]
        A[..., n:, :], T, rest = (
            np.take_along_axis(M, rows, axis=-2) for M in (A[..., n:, :], T, rest)
        )
        rest = np.take_along_axis(rest, dullest[..., None, :], axis=-1)
        h = np.take_along_axis(h, dullest, axis=-1)
    for i in range(k):
        r, f = rest[..., i, i], A[..., n + i, :]
        for m in range(i + 1, k):
            common = _share(rest[..., m, i], r)[..., None]
            A[..., n + m, :] -= common * f
            T[..., m, :] -= common * T[..., i, :]
            rest[..., m, :] -= common * rest[..., i, :]
        left, b, s_i = _carlson(A, f, r)
        nothing = s_i <= np.square(ROUNDING * h[..., i])
        A = np.where(nothing[..., None, None], A, left)
        s[..., i] = s_i = np.where(nothing, 0.0, s_i)
        gain = _share(b, s_i[..., None])
        K += gain[..., :n, None] * T[..., None, i, :]
        for m in range(i + 1, k):
            T[..., m, :] -= gain[..., n + m, None] * T[..., i, :]
    return Conditioned(A[..., :n, :], K, T, s)


def seen(H: Array) -> Array:
    """How much of each state a reading sees, in its own units : (…, n)"""
    seen: Array = np.sum(np.square(H), axis=-2)
    return seen


def _product(L: Array) -> Array:
    """L Lᵀ, exactly symmetric : (…, m, m)"""
    product: Array = (L[..., :, None, :] * L[..., None, :, :]).sum(axis=-1)
    return product


def _dullness(R: Array, D: Array) -> Array:
    """How much noisier than the belief each number is : (…, k), ∞ where that knows it."""
    known = np.sum(np.square(D), axis=-1)
    noise = np.diagonal(R, axis1=-2, axis2=-1)
    dullness: Array = np.divide(noise, known, out=np.full(known.shape, np.inf), where=known > 0)
    return dullness


def _share(part: Array, whole: Array) -> Array:
    """part / whole, 0 where the whole is none."""
    per = np.divide(1.0, whole, out=np.zeros_like(whole), where=whole > 0)
    return np.where(whole > 0, part * per, 0.0)


def _carlson(A: Array, f: Array, r: Array) -> tuple[Array, Array, Array]:
    """A (I − fᵀ f/s)^½ : (…, m, n)      b = A fᵀ : (…, m)      s = f fᵀ + r : (…)

    From the last column to the first, α being r and the squares of f so far, b the sum of f A so
    far.
    """
    left, b, α = np.empty_like(A), np.zeros_like(A[..., 0]), r
    for j in reversed(range(A.shape[-1])):
        f_j, A_j = f[..., j, None], A[..., j]
        more, noisy = α + np.square(f[..., j]), α > 0
        per = np.divide(1.0, more, out=np.zeros_like(more), where=noisy)
        kept = np.sqrt(α * per)
        turned = np.divide(per, kept, out=np.zeros_like(more), where=noisy)[..., None] * f_j
        kept_A = np.where(noisy | (more > 0), kept, 1.0)[..., None] * A_j
        rest = kept_A - turned * b
        left[..., j] = np.where(np.abs(rest) <= ROUNDING * np.abs(kept_A), 0.0, rest)
        b, α = b + f_j * A_j, more
    return left, b, α
