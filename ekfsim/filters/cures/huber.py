"""Assumes that a reading which lies far off is more likely a bad one than its prior a wrong one."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Belief, Correction, Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Sensor


@dataclass(frozen=True)
class Huber(EKF):
    """Extended Kalman filter with the weights of Huber, Robust estimation of a location parameter,
    1964, for its readings; compare Karlgaard & Schaub, Huber-based divided difference filtering,
    2007, which weighs the prior as well. All else is as in the EKF.
    """

    k: float = Tuning.huber  # σ of an innovation; beyond it a reading pulls no harder than there

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings, beginning.tuning.huber)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """w = min(1, k/√NIS)      R' = R + (1/w − 1) S, whence S' = S/w and K' = w K
        x = x⁻ + w K ν      P = (I − w K H) P⁻

        So ν/√S acts as ±k where it is larger. What is told, R, S, K and NIS, is the EKF's: they
        judge the reading, and are what they would be had it no weight.
        """
        posterior, told = super().update(prior, sensor, z, skip)
        w = weight(told.nis, limit(self.k, z.shape[-1]))
        trust = kalman.of_used(told, w)
        before = Gaussian(*prior)
        return kalman.trusting(trust, before, posterior, told, self.headings), replace(
            told, trust=trust
        )


def weight(nis: Array, limit: float) -> Array:
    """min(1, √(limit/NIS)) : (…), 1 of an innovation of 0"""
    return np.sqrt(limit / np.maximum(nis, limit)) if limit < math.inf else np.ones_like(nis)


def limit(k: float, numbers: int) -> float:
    """The NIS from which on a reading of so many numbers is weighed: k² of one, and of more what
    theirs is beyond as seldom.

    >>> limit(2, 1), round(limit(2, 2), 2)
    (4, 6.18)
    """
    return k * k if numbers == 1 else quantile(math.erf(k / math.sqrt(2)), numbers)
