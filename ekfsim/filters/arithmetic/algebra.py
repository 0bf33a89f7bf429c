"""The few lines of matrix algebra that the filters share."""

import numpy as np

from ekfsim.filters.arithmetic.tolerances import ROUNDING
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap


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


def uncertain(S: Array) -> tuple[Integers, Array]:
    """How many of the numbers of S : (…, k, k) are uncertain, and ln det S of these : (…). So a
    density is that of what can vary; as in `inverse` the correlations decide what that is.
    """
    if S.shape[-1] == 1:
        s = np.nan_to_num(S[..., 0, 0])
        return np.where(s > 0, 1, 0), np.log(np.where(s > 0, s, 1.0))
    S = np.nan_to_num(S)
    σσ = np.maximum(np.diagonal(S, axis1=-2, axis2=-1), 0.0)
    per = np.divide(1.0, np.sqrt(σσ), out=np.zeros_like(σσ), where=σσ > 0)
    λ = np.linalg.eigvalsh(S * (per[..., :, None] * per[..., None, :]))
    varies = λ > ROUNDING * λ.shape[-1]
    factors = np.log(np.where(varies, λ, 1.0)) + np.log(np.where(σσ > 0, σσ, 1.0))
    return np.count_nonzero(varies, axis=-1), np.sum(factors, axis=-1)


def gain_of_moments(cross: Array, S: Array) -> Array:
    """K = P_xz S⁻¹ : (…, n, k), told of a crowd, which itself needs none; that of the Kalman
    filters stands in kalman.py. Zero where nothing is uncertain (S = 0) or predicted (S is nan).

    cross : (…, n, k) is P_xz, the covariance of state and reading
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
        x[..., i] = wrap(x[..., i])
    return x
