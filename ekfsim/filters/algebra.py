"""The few lines of matrix algebra that the filters share."""

import math

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.filters.chi_square import quantile
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap, wrap_one

ROUNDING = 1e-14  # a sum below this share of its terms' sizes is what rounding leaves of 0
CERTAIN = 1e-20  # and so is an H P Hᵀ below this share of |H|² tr P, where sin π stands for 0


def symmetric(P: Array) -> Array:
    """The symmetric part, without the asymmetry that rounding leaves. P : (…, n, n)"""
    return 0.5 * (P + P.mT)


def innovation_covariance(P: Array, H: Array, R: Array) -> Array:
    """S = H P Hᵀ + R : (…, k, k), exactly R where the rest is rounding."""
    HPHt: Array = H @ P @ H.mT
    if P.ndim == H.ndim == 2 and HPHt.diagonal().min() > 2 * ROUNDING * float(np.vdot(H, H)) * float(P.trace()):
        return HPHt + R  # every variance is larger than what may be rounding
    sin_π = CERTAIN * np.sum(H * H, axis=(-2, -1)) * np.trace(P, axis1=-2, axis2=-1)
    rounding = ROUNDING * (np.abs(H) @ np.abs(P) @ np.abs(H.mT)) + sin_π[..., None, None]
    return np.where(np.abs(HPHt) <= rounding, 0.0, HPHt) + R


def settled(P: Array, prior: Array) -> Array:
    """P after an update, without what rounding leaves of a variance that a perfect sensor has made 0. Both (…, n, n)"""
    variances, before = (np.diagonal(M, axis1=-2, axis2=-1) for M in (P, prior))
    left = variances > ROUNDING * before
    if left.all():
        return P
    return P * (left[..., :, None] & left[..., None, :])


def inverse(S: Array) -> Array:
    """S⁻¹ : (…, k, k); where S is singular an inverse on its range, where it is nan 0.

    Metres and radians must not decide what is singular: the correlations do.
    """
    if S.shape == (2, 2):
        (a, b), (_, d) = S.tolist()
        det = a * d - b * b
        if det > ROUNDING * a * d:
            return np.array([[d / det, -b / det], [-b / det, a / det]])
    elif S.shape[-1] == 2:
        a, b, d = S[..., 0, 0], S[..., 0, 1], S[..., 1, 1]
        det = a * d - b * b
        if np.all(det > ROUNDING * a * d):
            return np.stack([d, -b, -b, a], axis=-1).reshape(S.shape) / det[..., None, None]
    S = np.nan_to_num(S)
    σ = np.sqrt(np.maximum(np.diagonal(S, axis1=-2, axis2=-1), 0.0))
    per = np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
    per_σσ = per[..., :, None] * per[..., None, :]
    inverted: Array = np.linalg.pinv(S * per_σσ, rtol=ROUNDING, hermitian=True) * per_σσ
    return inverted


def gain(cross: Array, S: Array) -> Array:
    """K = P_xz S⁻¹ : (…, n, k), zero where nothing is uncertain (S = 0) or nothing was predicted (S is nan).

    cross : (…, n, k) is P_xz, the covariance of state and reading: P Hᵀ where h is linearised.
    """
    if S.shape[-1] == 1:
        return np.divide(cross, S, out=np.zeros(np.broadcast_shapes(cross.shape, S.shape)), where=S > 0)
    K: Array = cross @ inverse(S)
    K[np.isnan(K)] = 0.0
    return K


def normalized_square(innovation: Array, S: Array) -> Array:
    """NIS = νᵀ S⁻¹ ν : (…), nan where S = 0 or nothing was measured or predicted."""
    if S.shape[-1] == 1:
        s, ν = S[..., 0, 0], innovation[..., 0]
        nis: Array = np.divide(ν * ν, s, out=np.full(np.broadcast_shapes(ν.shape, s.shape), np.nan), where=s > 0)
        return nis
    if S.ndim == 2 and innovation.ndim == 1:
        return np.array(innovation @ inverse(S) @ innovation if S.any() else np.nan)
    square = np.vecdot(innovation, np.matvec(inverse(S), innovation))
    return np.where(np.any(S != 0, axis=(-2, -1)), square, np.nan)


def wrapped(x: Array, headings: tuple[int, ...]) -> Array:
    """x : (…, n) with its headings in (−π, π], changed in place."""
    for i in headings:
        x[..., i] = wrap_one(float(x[i])) if x.ndim == 1 else wrap(x[..., i])
    return x


def refusal(z: Array, h: Array, nis: Array, skip: Booleans | bool, gate: float | None) -> Integers:
    """Why each reading is refused : (…) of `Refused`; the first reason that holds. z, h : (…, k)"""
    limit = np.inf if gate is None else quantile(gate, z.shape[-1])
    reasons = [
        (np.isnan(z).any(axis=-1), Refused.NO_ECHO),
        (np.isnan(h).any(axis=-1), Refused.NO_WALL),
        (np.asarray(skip), Refused.GUARD),
        (nis > limit, Refused.GATE),
    ]
    shape = np.broadcast_shapes(nis.shape, *(holds.shape for holds, _ in reasons))
    conditions = [np.broadcast_to(holds, shape) for holds, _ in reasons]
    return np.select(conditions, [np.int64(reason) for _, reason in reasons], np.int64(Refused.NOT))


def refusal_one(z: Array, h: Array, nis: float, skip: bool, gate: float | None) -> Refused:
    """The same for one reading of one robot."""
    if any(map(math.isnan, z.tolist())):
        return Refused.NO_ECHO
    if any(map(math.isnan, h.tolist())):
        return Refused.NO_WALL
    if skip:
        return Refused.GUARD
    return Refused.GATE if gate is not None and nis > quantile(gate, len(z)) else Refused.NOT
