"""Whether to believe the filter: NEES, NIS, inside or outside, and the verdict on a run."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ekfsim.filters.belief import Belief, Gaussian, Refused, posed
from ekfsim.filters.chi_square import band, quantile
from ekfsim.geometry import Array, Booleans, Integers, backend
from ekfsim.geometry.angles import wrap, wrap_one
from ekfsim.geometry.ellipse import cone_factor, radius_factor
from ekfsim.geometry.lanes import front
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Nees, Step

RANK = 1e-10  # an eigenvalue of the correlation matrix above this counts towards the rank
ROUNDING = 1e-12  # m, rad; a smaller standard deviation is what sin π leaves of none
# a determinant of the correlation matrix above this needs no eigenvalues to tell the rank
CLEAR = 1e-8
MANY = 64  # runs from which on they are told apart by rank
# m, rad; a longer part of the error outside the range of P makes the belief impossible
OUTSIDE = 1e-6
LOST = 0.999  # NEES beyond this χ² quantile: lost
BAND = 0.99  # the two-sided band that ΣNIS is held against
# a single NIS or NEES beyond this χ² quantile is called so; below no quantile is it surprising
SURPRISING = 0.99


def error(belief: Belief, truth: Array) -> Array:
    """e = estimate − truth of a pose : (…, 3), the heading wrapped"""
    e: Array = belief.mean - truth
    e[..., 2] = wrap_one(float(e[2])) if e.ndim == 1 else wrap(e[..., 2])
    return e


def nees(belief: Belief, truth: Array, layout: Layout = POSE) -> Nees:
    """Normalised estimation error squared of the pose, aware of the rank of its P. truth : (…,
    3)
    """
    pose = posed(belief, layout)
    value, rank, impossible = squared_error(error(pose, truth), pose.covariance)
    return Nees(
        np.where(impossible, np.nan, value) if np.count_nonzero(impossible) else value,
        rank,
        impossible,
    )


def inside_ellipse(belief: Gaussian, truth: Array, probability: float) -> Booleans:
    """Whether the true position lies inside the ellipse : (…)

    eᵀ P⁺ e ≤ k² on the position's block
    """
    e, P = error(belief, truth)[..., :2], belief.covariance[..., :2, :2]
    value, _, impossible = squared_error(e, P)
    return ~impossible & (value <= radius_factor(probability) ** 2)


def inside_cone(belief: Gaussian, truth: Array, probability: float) -> Booleans:
    """Whether the true heading lies inside the cone : (…)"""
    e, variance = error(belief, truth)[..., 2], belief.covariance[..., 2, 2]
    squared_reach = cone_factor(probability) ** 2 * variance
    return (e * e <= squared_reach) | ((variance <= 0) & (abs(e) <= OUTSIDE))


def squared_error(e: Array, P: Array) -> tuple[Array, Integers, Booleans]:
    """eᵀ P⁺ e, the rank of P, and whether e has a part outside the range of P : (…) each

    P is often singular: it starts at 0, and a straight move adds no heading noise. Metres and
    radians must not decide the rank, so it is counted on the correlation matrix: with D = diag(P),
    rows that are zero but for rounding dropped,

        C = D^{-1/2} P D^{-1/2} = V Λ Vᵀ      rank = #{λ > 1e-10}
        B = D^{1/2} V spans the range of P
        eᵀ P⁺ e = yᵀ Λ⁻¹ y      where B y is the part of e inside that range
    """
    if e.ndim == 1 and (value := _full_rank_square(e.tolist(), P.tolist())) is not None:
        return np.array(value), np.array(len(e)), np.array(False)
    if e.ndim == 2 and len(e) >= MANY and e.shape[-1] in (2, 3) and e.shape == P.shape[:-1]:
        return _squared_errors(e, P)
    return _squared_error(e, P)


def _squared_error(e: Array, P: Array) -> tuple[Array, Integers, Booleans]:
    """The same as its formulas stand."""
    σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 0.0))
    σ = np.where(σ > ROUNDING, σ, 0.0)
    per_σ = np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
    λ, V = np.linalg.eigh(P * per_σ[..., :, None] * per_σ[..., None, :])
    kept = λ > RANK
    if np.all(kept):
        y, outside = np.vecmat(e * per_σ, V), np.zeros(kept.shape[:-1])
    else:
        y, outside = _coordinates(e, σ[..., :, None] * V, kept)
    value = np.sum(np.divide(y * y, λ, out=np.zeros_like(y), where=kept), axis=-1)
    return value, np.count_nonzero(kept, axis=-1), outside > OUTSIDE


def _squared_errors(e: Array, P: Array) -> tuple[Array, Integers, Booleans]:
    """The same for many runs, by P = L D Lᵀ where P is clearly of full rank. Held equal to the
    above by a test.
    """
    n = e.shape[-1]
    if n == 3 and backend.used() == "numba":
        from ekfsim.filters.compiled import squares

        value, clear = squares(front(e, 1), front(P), ROUNDING**2, CLEAR)
    else:
        with np.errstate(all="ignore"):
            value, clear = _full_rank_squares(front(e, 1), front(P))
    rank, impossible = np.full(len(e), n), np.zeros(len(e), bool)
    if not clear.all():
        rest = ~clear
        value[rest], rank[rest], impossible[rest] = _squared_error(e[rest], P[rest])
    return value, rank, impossible


def _full_rank_squares(e: Array, P: Array) -> tuple[Array, Booleans]:
    """eᵀ P⁻¹ e : (N,), and where P is clearly of full rank; e : (n, N), P : (n, n, N). See
    `_full_rank_square`.
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


def _full_rank_square(e: list[float], P: list[list[float]]) -> float | None:
    """The same for one P that is clearly of full rank, by P = L D Lᵀ in plain floats; None where it
    is not clear.

    det C = Π Dᵢ/Pᵢᵢ, and no eigenvalue of C (they sum to n ≤ 3) is smaller than det C / 2.25. Held
    equal to the above by a test.
    """
    (a, b), (c, d) = P[0][:2], P[1][:2]
    if not a > ROUNDING**2 < d:
        return None
    k = c / a
    D = d - k * b
    y = e[1] - k * e[0]
    if not CLEAR * d < D:
        return None
    square = e[0] * e[0] / a + y * y / D
    if len(e) == 2:
        return square
    p, q, r = P[2]
    m = p / a
    n = (q - m * b) / D
    D3 = r - m * p - n * n * D
    if len(e) > 3 or not (r > ROUNDING**2 and CLEAR * d * r < D * D3):
        return None
    y3 = e[2] - m * e[0] - n * y
    return square + y3 * y3 / D3


def _coordinates(e: Array, B: Array, kept: Booleans) -> tuple[Array, Array]:
    """y, for which B y is the part of e in the span of the kept columns of B, and the length of the
    rest of e.

    The kept columns come last, as eigenvalues ascend. e : (…, n), B : (…, n, n) → (…, n), (…)
    """
    first = kept[..., ::-1]
    Q, R = np.linalg.qr(np.where(first[..., None, :], B[..., ::-1], 0.0))
    along = np.where(first, np.vecmat(e, Q), 0.0)
    y = np.linalg.solve(R + np.eye(e.shape[-1]) * ~first[..., None, :], along[..., None])[..., 0]
    rest = np.linalg.norm(e - np.matvec(Q, along), axis=-1)
    return np.asarray(y[..., ::-1], np.float64), np.asarray(rest, np.float64)


def lost(measured: Nees) -> bool:
    """Whether one run's NEES lies beyond its χ² 99.9 % quantile, or its belief is impossible."""
    return bool(measured.impossible) or float(measured.value) > quantile(LOST, int(measured.dof))


class Verdict(Enum):
    """What can be said of one run. The value is the word; `Evidence.sentence` gives its reason."""

    LOST = "lost"
    OVER_CONFIDENT = "over-confident"
    OVER_CAUTIOUS = "over-cautious"
    CONSISTENT = "consistent"
    NO_EVIDENCE = "no evidence"


@dataclass
class Evidence:
    """What the steps of one run say for and against its filter, gathered one at a time."""

    nis_sum: float = 0.0
    nis_dof: int = 0  # of the readings that had a NIS together, refused ones included
    lost_from: int | None = None  # index of the step from which on the run is lost without a gap
    last_nees: Nees | None = None
    nis_refused: int = 0  # how many readings of the sum were refused
    nis_readings: int = 0  # how many readings it sums

    def add(self, step: Step) -> None:
        """Take one more step into account."""
        if step.correction is not None and not np.isnan(step.correction.nis):
            self.nis_sum += float(step.correction.nis)
            self.nis_dof += step.correction.innovation.shape[-1]
            self.nis_readings += 1
            self.nis_refused += int(step.correction.refused != Refused.NOT)
        if step.nees is not None:
            self.last_nees = step.nees
            if not lost(step.nees):
                self.lost_from = None
            elif self.lost_from is None:
                self.lost_from = step.entry.index

    @property
    def nis_band(self) -> tuple[float, float]:
        """The two-sided 99 % band of χ² for ΣNIS."""
        return band(BAND, self.nis_dof)

    @property
    def verdict(self) -> Verdict:
        """Lost, else by ΣNIS against its band. NEES over time is correlated and never summed into a
        verdict.
        """
        low, high = self.nis_band
        if self.lost_from is not None:
            return Verdict.LOST
        if self.nis_dof == 0:
            return Verdict.NO_EVIDENCE
        if self.nis_sum > high:
            return Verdict.OVER_CONFIDENT
        return Verdict.OVER_CAUTIOUS if self.nis_sum < low else Verdict.CONSISTENT
