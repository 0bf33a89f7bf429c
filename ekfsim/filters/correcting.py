"""The end that the updates share: a reading is judged, and the belief revised where it is used."""

import math
from typing import NamedTuple

import numpy as np

from ekfsim.filters.algebra import SHARP, refusal, refusal_one, wrapped
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.conditioning import Conditioned, conditioned, slope, square_root, squared
from ekfsim.filters.conditioning_one import (
    conditioned_one,
    nis_one,
    slope_one,
    square_root_one,
    squared_one,
)
from ekfsim.geometry import Array, Booleans, Integers


class Linearized(NamedTuple):
    """A reading z, and beside it what a filter's linear sensor has to say of it."""

    z: Array  # (…, k)
    h: Array  # the reading that the prior predicts : (…, k)
    innovation: Array  # ν = z − h, wrapped where it is an angle : (…, k)
    H: Array  # (…, k, n)
    R: Array  # (…, k, k)


def corrected(
    prior: Gaussian,
    reading: Linearized,
    skip: Booleans | bool,
    gate: float | None,
    headings: tuple[int, ...],
) -> tuple[Gaussian, Correction]:
    """S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹      x = x⁻ + K ν      P = (I − KH) P⁻

    The Kalman filter's update with a reading that is linearised already. P by its square root, see
    conditioning.py.
    """
    if prior.mean.ndim == 1 and reading.z.ndim == 1:
        return _corrected_one(prior, reading, bool(skip), gate, headings)
    z, h, innovation, H, R = reading
    L = square_root(prior.covariance, seen(H))
    D = slope(H, L)
    learnt = conditioned(L, D, R, h)
    nis = learnt.nis(innovation)
    refused = refusal(z, h, nis, skip, gate)
    posterior = where_used(refused, revised(prior, learnt, innovation, headings), prior)
    return posterior, Correction(h, innovation, R, learnt.S(D, R), H, learnt.K, nis, refused)


def seen(H: Array) -> Array:
    """How much of each state a reading sees, in its own units : (…, n)"""
    seen: Array = np.sum(np.square(H), axis=-2)
    return seen


def revised(
    prior: Gaussian, learnt: Conditioned, innovation: Array, headings: tuple[int, ...]
) -> Gaussian:
    """x = x⁻ + K ν      P = L Lᵀ, the prior's own where nothing was learnt"""
    x, P = prior
    told = np.any(learnt.variances > 0, axis=-1)[..., None, None]
    mean = wrapped(x + np.matvec(learnt.K, innovation), headings)
    return Gaussian(mean, np.where(told, squared(learnt.root, P), P))


def where_used(refused: Integers, posterior: Gaussian, prior: Gaussian) -> Gaussian:
    """The posterior where the reading is used, the prior where it is refused."""
    if refused.ndim == 0 and prior.mean.ndim == 1:
        return posterior if refused == Refused.NOT else prior
    used = (refused == Refused.NOT)[..., None]
    return Gaussian(
        np.where(used, posterior.mean, prior.mean),
        np.where(used[..., None], posterior.covariance, prior.covariance),
    )


def _corrected_one(
    prior: Gaussian, reading: Linearized, skip: bool, gate: float | None, headings: tuple[int, ...]
) -> tuple[Gaussian, Correction]:
    """The same for one robot: a third of the time, held equal to the above by a test."""
    (x, P), (z, h, innovation, H, R) = prior, reading
    K, S, P_new, nis = _dull(P, H, R, innovation) or _any(P, H, R, h, innovation)
    refused = refusal_one(z, h, nis, skip, gate)
    posterior = prior
    if refused is Refused.NOT and not math.isnan(nis):
        posterior = Gaussian(wrapped(x + K @ innovation, headings), P_new)
    return posterior, Correction(h, innovation, R, S, H, K, np.array(nis), np.array(int(refused)))


def _dull(
    P: Array, H: Array, R: Array, innovation: Array
) -> tuple[Array, Array, Array, float] | None:
    """K, S, P and NIS of one number that leaves of every variance so much that the textbook's
    difference is right.
    """
    if len(innovation) != 1:
        return None
    row, r = H[0], float(R[0, 0])
    if not r > SHARP * float(row * row @ P.diagonal()):
        return None
    PHt = P @ row
    s = float(row @ PHt) + r
    column = PHt[:, None]
    return column / s, np.array([[s]]), P - column * PHt / s, float(innovation[0]) ** 2 / s


def _any(
    P: Array, H: Array, R: Array, h: Array, innovation: Array
) -> tuple[Array, Array, Array, float]:
    """K, S, P and NIS by the square root of P, in plain floats."""
    rows, slopes = P.tolist(), H.tolist()
    L = square_root_one(rows, slopes)
    root, K, T, s = conditioned_one(L, slope_one(slopes, L), R.tolist(), h.tolist())
    S = np.array([[s[0]]]) if len(s) == 1 else H @ P @ H.mT + R if any(s) else np.zeros_like(R)
    return np.array(K), S, np.array(squared_one(root, rows)), nis_one(T, s, innovation.tolist())
