"""Predict, gain, update: what the Kalman filters have in common, once.

ekf.py, kf.py, iekf.py and ukf.py say how f and h are made linear; all else is here. Equations are
those of the assignment, section 3 (document 002). P is taken apart as L Lᵀ, for the textbook's
difference P − K H P loses its digits where a sensor is sharp; see arithmetic/square_root.py.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.arithmetic.square_root import (
    Conditioned,
    conditioned,
    covariance,
    seen,
    slope,
    square_root,
)
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.twins import twinned


class Linearized(NamedTuple):
    """A reading z, and the line that a filter takes its sensor for: h + H (x − x⁻) + v, v of
    covariance R.
    """

    z: Array  # (…, k)
    h: Array  # the reading that the prior predicts : (…, k)
    innovation: Array  # ν = z − h, wrapped where it is an angle : (…, k)          eq. 9
    H: Array  # (…, k, n)
    R: Array  # (…, k, k)


class Rule(NamedTuple):
    """How a filter uses a reading."""

    gate: float | None  # probability; a reading whose NIS lies beyond that χ² quantile is refused
    skip: Booleans | bool  # (…) readings that are judged and not used
    headings: tuple[int, ...]  # which entries of the state are headings, kept in (−π, π]


@twinned
def predict(P: Array, F: Array, G: Array, M: Array, Q: Array | float) -> Array:
    """P⁻ = F P Fᵀ + G M Gᵀ + Q : (…, n, n)          eq. 7"""
    return noisy(F @ P @ F.mT, G, M, Q)


def noisy(P: Array, G: Array, M: Array, Q: Array | float) -> Array:
    """P + G M Gᵀ + Q : (…, n, n), P and what a motion's noise adds to it"""
    return covariance(P + G @ M @ G.mT + Q)


def gain(L: Array, D: Array, R: Array, h: Array) -> Conditioned:
    """S = D Dᵀ + R      K = L Dᵀ S⁻¹ : (…, n, k), which is P⁻ Hᵀ S⁻¹, as P⁻ = L Lᵀ and D = H L
    eq. 11

    K is 0 where nothing is uncertain. With it come the root of P = (I − K H) P⁻, eq. 12, and what
    NIS = νᵀ S⁻¹ ν is calculated from.
    """
    return conditioned(L, D, R, h)


@twinned
def update(prior: Gaussian, reading: Linearized, rule: Rule) -> tuple[Gaussian, Correction]:
    """S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹      x = x⁻ + K ν      P = (I − K H) P⁻
    eqs 10 to 12

    Where the reading is refused the belief stays as it is; ν, S, K and NIS are told all the same.
    """
    L = square_root(prior.covariance, seen(reading.H))
    return revise(prior, reading, rule, L, slope(reading.H, L))


def revise(
    prior: Gaussian, reading: Linearized, rule: Rule, L: Array, D: Array
) -> tuple[Gaussian, Correction]:
    """`update`, P⁻ = L Lᵀ being taken apart already, and D = H L : (…, k, n) known as well."""
    x, P = prior
    z, h, ν, H, R = reading
    learnt = gain(L, D, R, h)
    nis = learnt.nis(ν)
    refused = refusal(z, h, nis, rule)
    mean = wrapped(x + np.matvec(learnt.K, ν), rule.headings)  # eq. 10
    posterior = where_used(refused, Gaussian(mean, learnt.covariance(P)), prior)
    return posterior, Correction(h, ν, R, learnt.S(D, R), H, learnt.K, nis, refused)


def refusal(z: Array, h: Array, nis: Array, rule: Rule) -> Integers:
    """Why each reading is refused : (…) of `Refused`; the first reason that holds. z, h : (…, k)"""
    limit = np.inf if rule.gate is None else quantile(rule.gate, z.shape[-1])
    reasons = [
        (np.isnan(z).any(axis=-1), Refused.NO_ECHO),
        (np.isnan(h).any(axis=-1), Refused.NO_WALL),
        (np.asarray(rule.skip), Refused.GUARD),
        (nis > limit, Refused.GATE),
    ]
    shape = np.broadcast_shapes(nis.shape, *(holds.shape for holds, _ in reasons))
    conditions = [np.broadcast_to(holds, shape) for holds, _ in reasons]
    return np.select(conditions, [np.int64(reason) for _, reason in reasons], np.int64(Refused.NOT))


def of_used(told: Correction, trust: Array) -> Array:
    """How far each reading is believed : (…), nan where it is not used."""
    return np.where(told.used, trust, np.nan)


def trusting(
    trust: Array, prior: Gaussian, posterior: Gaussian, told: Correction, headings: tuple[int, ...]
) -> Gaussian:
    """x = x⁻ + w K ν      P = (1 − w) P⁻ + w (I − K H) P⁻

    What of an update is left of readings that are believed to the share w. trust : (…), w in
    [0, 1]; where it is 1, or nan, all is as it was updated
    """
    w = trust[..., None]
    mean = wrapped(prior.mean + w * np.matvec(told.K, told.innovation), headings)
    P = (1 - w[..., None]) * prior.covariance + w[..., None] * posterior.covariance
    less = w < 1
    return Gaussian(
        np.where(less, mean, posterior.mean),
        np.where(less[..., None], covariance(P), posterior.covariance),
    )


def where_used(refused: Integers, posterior: Gaussian, prior: Gaussian) -> Gaussian:
    """The posterior where the reading is used, the prior where it is refused."""
    used = (refused == Refused.NOT)[..., None]
    return Gaussian(
        np.where(used, posterior.mean, prior.mean),
        np.where(used[..., None], posterior.covariance, prior.covariance),
    )
