"""Assumes that the prior is right, and a reading either of what it expects or of clutter."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.algebra import uncertain
from ekfsim.filters.belief import Belief, Correction, Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Sensor

SURELY_CLUTTER = 700.0  # ln of odds: exp of more is no number


@dataclass(frozen=True)
class PDAF(EKF):
    """Probabilistic data association filter of one reading at a time: Bar-Shalom, Daum & Huang, The
    probabilistic data association filter, IEEE Control Systems, 2009, with the density of clutter
    known. All else is as in the EKF.
    """

    clutter: float = Tuning.clutter  # the share of readings that are of something else
    density: float = Tuning.clutter_density  # of those, per unit (m, rad) of each number

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        own = beginning.tuning
        return cls(beginning.gate, beginning.headings, own.clutter, own.clutter_density)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """β = (1 − c) N(ν; 0, S) / ((1 − c) N(ν; 0, S) + c λᵏ)
        x = x⁻ + β K ν      P = (1 − β) P⁻ + β (I − K H) P⁻ + β (1 − β) K ν νᵀ Kᵀ

        These are the moments of a mixture: with probability β the EKF's posterior, else the prior.
        c : clutter, λ : its density. What is told, S, K and NIS, is the EKF's.
        """
        posterior, told = super().update(prior, sensor, z, skip)
        β = kalman.of_used(told, association(told, self.clutter, self.density))
        x, P = kalman.trusting(β, Gaussian(*prior), posterior, told, self.headings)
        apart = np.matvec(told.K, told.innovation)  # the two parts of the mixture
        outer = apart[..., :, None] * apart[..., None, :]
        spread = np.where(β[..., None, None] < 1, (β * (1 - β))[..., None, None] * outer, 0.0)
        P += spread
        return Gaussian(x, P), replace(told, trust=β)


def association(told: Correction, clutter: float, density: float) -> Array:
    """β : (…), that a reading is of what was expected; 1 where there is no clutter.

    What is certain beforehand among its numbers tells neither.
    """
    k, ln_S = uncertain(told.S)
    ln_odds = ln_clutter(clutter, density, k) + (ln_S + told.nis) / 2
    β: Array = 1 / (1 + np.exp(np.minimum(ln_odds, SURELY_CLUTTER)))
    return β


def ln_clutter(clutter: float, density: float, k: int | Integers) -> Array:
    """ln c λᵏ √(2π)ᵏ/(1 − c) : (…), of the odds for clutter what no reading of k : (…) numbers
    changes; −∞ where there is none.
    """
    with np.errstate(divide="ignore"):
        of_share = np.log(clutter) - np.log1p(-clutter)
        return np.asarray(of_share + k * np.log(density * np.sqrt(2 * np.pi)))
