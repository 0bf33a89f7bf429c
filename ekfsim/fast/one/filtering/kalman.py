"""kalman.py of one robot: a third of the time."""

import math

import numpy as np

from ekfsim.fast.one.filtering.square_root import (
    conditioned_one,
    nis_one,
    slope_one,
    square_root_one,
    squared_one,
)
from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.arithmetic.tolerances import SHARP
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.kalman import Linearized, Rule
from ekfsim.geometry import Array


def update(prior: Gaussian, reading: Linearized, rule: Rule) -> tuple[Gaussian, Correction] | None:
    """K = P⁻ Hᵀ S⁻¹      x = x⁻ + K ν      P = (I − K H) P⁻"""
    (x, P), (z, h, innovation, H, R) = prior, reading
    if x.ndim != 1 or z.ndim != 1 or h.ndim != 1 or R.ndim != 2:
        return None
    K, S, P_new, nis = _dull(P, H, R, innovation) or _any(P, H, R, h, innovation)
    refused = refusal(z, h, nis, rule)
    posterior = prior
    if refused is Refused.NOT and not math.isnan(nis):
        mean = x + K @ innovation
        for i in rule.headings:
            mean[i] = wrap_one(float(mean[i]))
        posterior = Gaussian(mean, P_new)
    return posterior, Correction(h, innovation, R, S, H, K, np.array(nis), np.array(int(refused)))


def refusal(z: Array, h: Array, nis: float, rule: Rule) -> Refused:
    """The first reason that holds."""
    if any(map(math.isnan, z.tolist())):
        return Refused.NO_ECHO
    if any(map(math.isnan, h.tolist())):
        return Refused.NO_WALL
    if rule.skip:
        return Refused.GUARD
    beyond = rule.gate is not None and nis > quantile(rule.gate, len(z))
    return Refused.GATE if beyond else Refused.NOT


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
