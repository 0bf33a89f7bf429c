"""The NEES of many runs: P = L D Lᵀ, entry by entry, where its rank is clear without
eigenvalues.
"""

import functools
from collections.abc import Callable

import numpy as np

from ekfsim.diagnostics.nees import OUTSIDE, ROUNDING, error
from ekfsim.diagnostics.nees import squared_mahalanobis as squares
from ekfsim.filters.belief import Belief, posed
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.soa import to_soa
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Nees
from ekfsim.twins import as_written

# a determinant of the correlation matrix above this needs no eigenvalues to tell the rank
CLEAR = 1e-8
# below NONE an eigenvalue of it is rounding; above PLANE two of them are clearly none
NONE, PLANE = 1e-14, 1e-2
UNCLEAR = -1  # in place of a rank
MANY = 64  # runs from which on they are told apart by rank

# eᵀ P⁻¹ e : (N,), and where P is clearly of full rank; of e : (n, N) and P : (n, n, N)
Squares = Callable[[Array, Array], tuple[Array, Booleans]]


def nees(belief: Belief, truth: Array, layout: Layout = POSE) -> Nees | None:
    """The NEES of many poses."""
    if truth.ndim != 2 or len(truth) < MANY:
        return None
    pose = posed(belief, layout)
    value, rank, impossible = squares(error(pose, truth), pose.covariance)
    if impossible.any():
        value[impossible] = np.nan
    return Nees(value, rank, impossible)


def squared_mahalanobis(e: Array, P: Array) -> tuple[Array, Integers, Booleans] | None:
    """eᵀ P⁺ e of many runs in two or three dimensions, those by the text whose rank is not
    clear.
    """
    return judged(e, P, full_rank)


def judged(e: Array, P: Array, full: Squares) -> tuple[Array, Integers, Booleans] | None:
    """`squared_mahalanobis` by one that judges what is clearly of full rank."""
    n = e.shape[-1]
    if e.ndim != 2 or len(e) < MANY or n not in (2, 3) or e.shape != P.shape[:-1]:
        return None
    with np.errstate(all="ignore"):
        value, clear = full(to_soa(e, 1), to_soa(P))
    rank, impossible = np.full(len(e), n), np.zeros(len(e), bool)
    for judge in (singular, as_written(squares)):
        if clear.all():
            break
        rest = those(~clear)
        value[rest], rank[rest], impossible[rest] = judge(e[rest], P[rest])
        clear[rest] = rank[rest] != UNCLEAR
    return value, rank, impossible


def those(runs: Booleans) -> slice | Integers:
    """An index of these runs: that of all of them takes no copy."""
    return slice(None) if runs.all() else np.flatnonzero(runs)


def full_rank(e: Array, P: Array) -> tuple[Array, Booleans]:
    """eᵀ P⁻¹ e : (N,), and where P is clearly of full rank; e : (n, N), P : (n, n, N)

    det C = Π Dᵢ/Pᵢᵢ, and no eigenvalue of C (they sum to n ≤ 3) is smaller than det C / 2.25.
    """
    a, b, d = P[0, 0], P[0, 1], P[1, 1]
    k = b / a
    D = d - k * b
    y = e[1] - k * e[0]
    square = e[0] * e[0] / a + y * y / D
    clear = (a > ROUNDING**2) & (d > ROUNDING**2) & (CLEAR * d < D)
    if len(e) == 2:
        return square, clear
    p, q, r = P[2]
    m = p / a
    c = q - m * b
    n = c / D
    D3 = r - m * p - n * c
    y3 = e[2] - m * e[0] - n * y
    square += y3 * y3 / D3
    return square, clear & (r > ROUNDING**2) & (CLEAR * d * r < D * D3)


def singular(e: Array, P: Array) -> tuple[Array, Integers, Booleans]:
    """The same where P is singular, in closed form; of rank UNCLEAR where no rank is clear.

    With m_ij = 1 − ρ_ij² of each pair of entries whose variances are not zero,

        λ₁λ₂ + λ₁λ₃ + λ₂λ₃ = Σ m_ij        λ₁λ₂λ₃ = det C

    tell the rank. P of rank 1 is B Bᵀ, and its trace BᵀB. P of rank 2 is known from
    the two entries with the largest m_ij: what it makes of the third, k, are the weights w, and
    (w, −1) is its null vector.
    """
    n = e.shape[-1]
    e, P = to_soa(e, 1), to_soa(P)
    variance = P.diagonal().T
    there = variance > ROUNDING**2
    pairs = [(i, j) for i in range(n) for j in range(i)]
    value, rank, outside = np.zeros(e.shape[1]), np.full(e.shape[1], UNCLEAR), np.zeros(e.shape[1])
    with np.errstate(all="ignore"):
        apart = [_apart(P[i, j], variance[i], variance[j]) for i, j in pairs]
        minors = functools.reduce(np.add, apart)
        if (line := minors < NONE).any():
            some = those(line)
            rank[some] = there[:, some].any(axis=0)
            value[some], outside[some] = _line(e[:, some], P[:, :, some], there[:, some])
        if n == 3 and (clear := minors > PLANE).any():
            widest = np.where(clear, np.argmax(apart, axis=0), UNCLEAR)
            for pair in np.unique(widest[clear]).tolist():
                (i, j), some = pairs[pair], those(widest == pair)
                k = 3 - i - j
                found = _plane(e[:, some], P[:, :, some], there[k, some], i, j, k)
                value[some], outside[some], third = found
                least = apart[pair][some] * third / minors[some]  # λ₃
                rank[some] = np.where(abs(least) < NONE, 2, UNCLEAR)
    return value, rank, outside > OUTSIDE


def _apart(b: Array, a: Array, d: Array) -> Array:
    """1 − ρ² of two entries with the variances a and d and the covariance b, 0 where one of them
    has none : (N,)
    """
    return np.where((a > ROUNDING**2) & (d > ROUNDING**2), 1 - b / a * b / d, 0.0)


def _line(e: Array, P: Array, there: Booleans) -> tuple[Array, Array]:
    """eᵀ P⁺ e of P = B Bᵀ, and the length of what of e is not along B : (N,) each

    B Bᵀ e / BᵀB = P e / tr P is the part of e along B.
    """
    inside = np.where(there, e, 0.0)
    total = np.where(there, P.diagonal().T, 0.0).sum(axis=0)
    along = np.einsum("ijk,jk->ik", P, inside)
    along = np.where(there, along / total, 0.0)
    value = np.where(there.any(axis=0), (inside * along).sum(axis=0) / total, 0.0)
    return value, np.sqrt(((e - along) ** 2).sum(axis=0))


def _plane(
    e: Array, P: Array, there: Booleans, i: int, j: int, k: int
) -> tuple[Array, Array, Array]:
    """eᵀ P⁺ e of a P of rank 2 that its entries i and j span, the length of what of e lies outside
    that plane, and which share of the variance of k does, too : (N,) each

    there : (N,) whether k has a variance at all
    """
    a, b, d = P[i, i], P[i, j], P[j, j]
    p, q, r = np.where(there, P[k, i], 0.0), np.where(there, P[k, j], 0.0), P[k, k]
    slope = b / a
    D = d - slope * b
    wj = (q - slope * p) / D
    wi = (p - b * wj) / a
    rest = e[k] - wi * e[i] - wj * e[j]
    square = 1 + wi * wi + wj * wj  # of the null vector
    x, y = e[i] + wi * rest / square, e[j] + wj * rest / square
    y = y - slope * x
    third = np.where(there, (r - wi * p - wj * q) / r, 0.0)
    return x * x / a + y * y / D, abs(rest) / np.sqrt(square), third
