"""The end that the updates share: a reading is judged, and the belief revised where it is used."""

from typing import NamedTuple

import numpy as np

from ekfsim.filters.algebra import refusal, refusal_one, wrapped
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.conditioning import (
    Conditioned,
    conditioned,
    conditioned_one,
    nis_one,
    slope,
    slope_one,
    square_root,
    square_root_one,
    squared,
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
    prior: Gaussian, reading: Linearized, skip: Booleans | bool, gate: float | None, headings: tuple[int, ...]
) -> tuple[Gaussian, Correction]:
    """S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹      x = x⁻ + K ν      P = (I − KH) P⁻

    The Kalman filter's update with a reading that is linearised already. P by its square root, see conditioning.py.
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


def revised(prior: Gaussian, learnt: Conditioned, innovation: Array, headings: tuple[int, ...]) -> Gaussian:
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
    """The same for one robot in plain floats: a third of the time, held equal to the above by a test."""
    (x, P), (z, h, innovation, H, R) = prior, reading
    rows, slopes, noise = P.tolist(), H.tolist(), R.tolist()
    L = square_root_one(rows, slopes)
    D = slope_one(slopes, L)
    root, K_rows, T, s = conditioned_one(L, D, noise, h.tolist())
    nis = nis_one(T, s, innovation.tolist())
    refused = refusal_one(z, h, nis, skip, gate)
    K, S = np.array(K_rows), np.array([[s[0]]]) if len(s) == 1 else H @ P @ H.mT + R if any(s) else np.zeros_like(R)
    posterior = prior
    if refused is Refused.NOT and any(s):
        posterior = Gaussian(wrapped(x + K @ innovation, headings), np.array(squared_one(root, rows)))
    return posterior, Correction(h, innovation, R, S, H, K, np.array(nis), np.array(int(refused)))
