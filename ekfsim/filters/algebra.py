"""The few lines of matrix algebra that the filters share."""

import math

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.filters.chi_square import quantile
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap, wrap_one

# a difference below this share of what it is taken of is rounding
ROUNDING = 16 * float(np.finfo(float).eps)
SHARP = 1e-4  # of Σ Hᵢ² Pᵢᵢ; a sensor of less noise leaves less than P − K H P may be trusted with


def symmetric(P: Array) -> Array:
    """The symmetric part, without the asymmetry that rounding leaves. P : (…, n, n)"""
    return 0.5 * (P + P.mT)


def inverse(S: Array) -> Array:
    """S⁻¹ : (…, k, k); where S is singular an inverse on its range, where it is nan 0.

    Metres and radians must not decide what is singular: the correlations do.
    """
    S = np.nan_to_num(S)
    σ = np.sqrt(np.maximum(np.diagonal(S, axis1=-2, axis2=-1), 0.0))
    per = np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
    per_σσ = per[..., :, None] * per[..., None, :]
    inverted: Array = np.linalg.pinv(S * per_σσ, rtol=ROUNDING, hermitian=True) * per_σσ
    return inverted


def gain(cross: Array, S: Array) -> Array:
    """K = P_xz S⁻¹ : (…, n, k), zero where nothing is uncertain (S = 0) or nothing was predicted (S
    is nan).

    cross : (…, n, k) is P_xz, the covariance of state and reading: P Hᵀ where h is linearised.
    """
    if S.shape[-1] == 1:
        return np.divide(
            cross, S, out=np.zeros(np.broadcast_shapes(cross.shape, S.shape)), where=S > 0
        )
    K: Array = cross @ inverse(S)
    K[np.isnan(K)] = 0.0
    return K


def normalized_square(innovation: Array, S: Array) -> Array:
    """NIS = νᵀ S⁻¹ ν : (…), nan where S = 0 or nothing was measured or predicted."""
    if S.shape[-1] == 1:
        s, ν = S[..., 0, 0], innovation[..., 0]
        nis: Array = np.divide(
            ν * ν, s, out=np.full(np.broadcast_shapes(ν.shape, s.shape), np.nan), where=s > 0
        )
        return nis
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
