"""Normalised estimation error squared (NEES): Bar-Shalom, Li & Kirubarajan, Estimation with
Applications to Tracking and Navigation, 2001, section 5.4.
"""

import numpy as np

from ekfsim.filters.belief import Belief, posed
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Nees
from ekfsim.twins import twinned

RANK = 1e-10  # an eigenvalue of the correlation matrix above this counts towards the rank
ROUNDING = 1e-12  # m, rad; a smaller standard deviation is what sin π leaves of none
# m, rad; a longer part of the error outside the range of P makes the belief impossible
OUTSIDE = 1e-6


def error(belief: Belief, truth: Array) -> Array:
    """e = estimate − truth of a pose : (…, 3), the heading wrapped"""
    e: Array = belief.mean - truth
    e[..., 2] = wrap(e[..., 2])
    return e


@twinned
def nees(belief: Belief, truth: Array, layout: Layout = POSE) -> Nees:
    """NEES of the pose: eᵀ P⁺ e, χ² of as many degrees of freedom as P has rank.

    truth : (…, 3)
    """
    pose = posed(belief, layout)
    value, rank, impossible = squared_mahalanobis(error(pose, truth), pose.covariance)
    return Nees(np.where(impossible, np.nan, value), rank, impossible)


@twinned
def squared_mahalanobis(e: Array, P: Array) -> tuple[Array, Integers, Booleans]:
    """eᵀ P⁺ e, the rank of P, and whether e has a part outside the range of P : (…) each

    P is often singular: it starts at 0, and a straight move adds no heading noise. Metres and
    radians must not decide the rank, so it is counted on the correlation matrix: with D = diag(P),
    rows that are zero but for rounding dropped,

        C = D^{-1/2} P D^{-1/2} = V Λ Vᵀ      rank = #{λ > 1e-10}
        B = D^{1/2} V spans the range of P
        eᵀ P⁺ e = yᵀ Λ⁻¹ y      where B y is the part of e inside that range

    e : (…, n), P : (…, n, n)
    """
    σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 0.0))
    σ = np.where(σ > ROUNDING, σ, 0.0)
    per_σ = np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
    λ, V = np.linalg.eigh(P * per_σ[..., :, None] * per_σ[..., None, :])
    kept = λ > RANK
    y, outside = coordinates(e, σ[..., :, None] * V, kept)
    full = np.all(kept, axis=-1)  # there B is D^{1/2} V, and y its inverse
    y = np.where(full[..., None], np.vecmat(e * per_σ, V), y)
    value = np.sum(np.divide(y * y, λ, out=np.zeros_like(y), where=kept), axis=-1)
    return value, np.count_nonzero(kept, axis=-1), (outside > OUTSIDE) & ~full


def coordinates(e: Array, B: Array, kept: Booleans) -> tuple[Array, Array]:
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
