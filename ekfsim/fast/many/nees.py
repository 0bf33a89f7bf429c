"""The NEES of many runs: P = L D Lᵀ, entry by entry, where its rank is clear without
eigenvalues.
"""

import numpy as np

from ekfsim.diagnostics.nees import ROUNDING, error
from ekfsim.diagnostics.nees import squared_mahalanobis as squares
from ekfsim.filters.belief import Belief, posed
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.soa import front
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Nees
from ekfsim.twins import as_written, taken

# a determinant of the correlation matrix above this needs no eigenvalues to tell the rank
CLEAR = 1e-8
MANY = 64  # runs from which on they are told apart by rank


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
    n = e.shape[-1]
    if e.ndim != 2 or len(e) < MANY or n not in (2, 3) or e.shape != P.shape[:-1]:
        return None
    if n == 3 and taken() == "compiled":
        from ekfsim.filters import compiled

        value, clear = compiled.squares(front(e, 1), front(P), ROUNDING**2, CLEAR)
    else:
        with np.errstate(all="ignore"):
            value, clear = _full_rank(front(e, 1), front(P))
    rank, impossible = np.full(len(e), n), np.zeros(len(e), bool)
    if not clear.all():
        rest = ~clear
        value[rest], rank[rest], impossible[rest] = as_written(squares)(e[rest], P[rest])
    return value, rank, impossible


def _full_rank(e: Array, P: Array) -> tuple[Array, Booleans]:
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
