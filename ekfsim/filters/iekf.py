"""The iterated extended Kalman filter."""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters.algebra import refusal
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction, Refused
from ekfsim.filters.conditioning import conditioned, slope, square_root, squared
from ekfsim.filters.correcting import seen, where_used
from ekfsim.filters.descent import Search
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True)
class IEKF:
    """Iterated extended Kalman filter: Bar-Shalom, Li & Kirubarajan, Estimation, 2001, section
    10.5.2.

    The update is a Gauss–Newton search for the most probable state: h is linearised again at what
    the update gives, until that no longer moves. A step that does not lead to a more probable state
    is halved until it does: Skoglund, Hendeby & Axehill, Extended Kalman filter modifications based
    on an optimization view point, 2015. A linear sensor is linearised alike everywhere, and all is
    as in the EKF.
    """

    remark: ClassVar[str] = ""
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    # how many steps the search takes at most, half a step counting as half
    iterations: int = Tuning.iterations

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings, beginning.tuning.iterations)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = f(x, u)      P⁻ = F P Fᵀ + G M Gᵀ + Q
        as the EKF does: there is nothing to iterate
        """
        return EKF(self.gate, self.headings).predict(belief, motion, u)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """x₀ = x⁻      Hᵢ = H(xᵢ)      Kᵢ = P⁻ Hᵢᵀ (Hᵢ P⁻ Hᵢᵀ + R)⁻¹
        xᵢ₊₁ = xᵢ + t (x⁻ + Kᵢ (z − h(xᵢ) − Hᵢ (x⁻ − xᵢ)) − xᵢ), t = 1, ½, ¼, … until it lowers

            J(x) = (x − x⁻)ᵀ P⁻⁺ (x − x⁻) + (z − h(x))ᵀ R⁻¹ (z − h(x))

        P = (I − KᵢHᵢ) P⁻ at the last i. R stays that of x⁻, as a sum of squares needs one measure.
        What the reading is judged by, ν, S and NIS, comes from the prediction x⁻; H and K are those
        of the last i.
        """
        if self.iterations == 0:
            return EKF(self.gate, self.headings).update(prior, sensor, z, skip)
        x, P = prior
        h, H, R = sensor.linearize(x)
        ν = sensor.residual(z, h)
        L = square_root(P, seen(H))
        D = slope(H, L)
        learnt = conditioned(L, D, R, h)
        S, nis = learnt.S(D, R), learnt.nis(ν)
        refused = refusal(z, h, nis, skip, self.gate)
        search = Search(sensor, z, x, L, R, S, self.headings)
        best, settled = search.descend(ν, h, H, refused == Refused.NOT, self.iterations)
        h_i, H_i, _ = sensor.linearize(best)
        last = conditioned(L, slope(H_i, L), R, h_i)
        told = np.any(last.variances > 0, axis=-1)[..., None, None]
        posterior = Gaussian(best, np.where(told, squared(last.root, P), P))
        return where_used(refused, posterior, Gaussian(x, P)), Correction(
            h, ν, R, S, H_i, last.K, nis, refused, settled
        )
