"""The end that the updates share: a reading is judged, and the belief revised where it is used."""

from typing import NamedTuple

import numpy as np

from ekfsim.filters.algebra import (
    gain,
    innovation_covariance,
    normalized_square,
    refusal,
    refusal_one,
    settled,
    symmetric,
    wrapped,
)
from ekfsim.filters.belief import Correction, Gaussian, Refused
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
    """S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹      x = x⁻ + K ν      P by Joseph's form

    The Kalman filter's update with a reading that is linearised already.
    """
    z, h, innovation, H, R = reading
    S = innovation_covariance(prior.covariance, H, R)
    nis, refused = judged(z, h, innovation, S, skip, gate)
    K = gain(prior.covariance @ H.mT, S)
    posterior = where_used(refused, revised(prior, K, H, R, innovation, headings), prior)
    return posterior, Correction(h, innovation, R, S, H, K, nis, refused)


def judged(
    z: Array, h: Array, innovation: Array, S: Array, skip: Booleans | bool, gate: float | None
) -> tuple[Array, Integers]:
    """NIS and why the reading is refused : (…) each"""
    nis = normalized_square(innovation, S)
    if nis.ndim == 0 and z.ndim == h.ndim == 1 and np.ndim(skip) == 0:
        return nis, np.array(int(refusal_one(z, h, float(nis), bool(skip), gate)))
    return nis, refusal(z, h, nis, skip, gate)


def revised(prior: Gaussian, K: Array, H: Array, R: Array, innovation: Array, headings: tuple[int, ...]) -> Gaussian:
    """x = x⁻ + K ν      P = (I − KH) P⁻ (I − KH)ᵀ + K R Kᵀ          Joseph's form: right for any K"""
    x, P = prior
    I_KH = np.eye(P.shape[-1]) - K @ H
    joseph = I_KH @ P @ I_KH.mT + K @ R @ K.mT
    return Gaussian(wrapped(x + np.matvec(K, innovation), headings), settled(symmetric(joseph), P))


def where_used(refused: Integers, posterior: Gaussian, prior: Gaussian) -> Gaussian:
    """The posterior where the reading is used, the prior where it is refused."""
    if refused.ndim == 0 and prior.mean.ndim == 1:
        return posterior if refused == Refused.NOT else prior
    used = (refused == Refused.NOT)[..., None]
    return Gaussian(
        np.where(used, posterior.mean, prior.mean),
        np.where(used[..., None], posterior.covariance, prior.covariance),
    )
