"""The iterated extended Kalman filter."""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters.algebra import gain, innovation_covariance, wrapped
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction, Refused
from ekfsim.filters.correcting import judged, revised, where_used
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor

CONVERGED = 1e-12  # standard deviations; an iteration that moves every entry by less is the last


@dataclass(frozen=True)
class IEKF:
    """Iterated extended Kalman filter: Bar-Shalom, Li & Kirubarajan, Estimation, 2001, section 10.5.2.

    The update is a Gauss–Newton search for the most probable state: h is linearised again at what the update gives,
    until that no longer moves. A linear sensor is linearised alike everywhere, and all is as in the EKF.
    """

    remark: ClassVar[str] = ""
    gate: float | None = None  # probability; a reading whose NIS lies beyond that χ² quantile is refused
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    iterations: int = Tuning.iterations  # how often h is linearised again at most; 0 is the EKF

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings, beginning.tuning.iterations)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = f(x, u)      P⁻ = F P Fᵀ + G M Gᵀ + Q          as the EKF does: there is nothing to iterate"""
        return EKF(self.gate, self.headings).predict(belief, motion, u)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """x₀ = x⁻      Hᵢ = H(xᵢ)      Kᵢ = P⁻ Hᵢᵀ (Hᵢ P⁻ Hᵢᵀ + R)⁻¹
        xᵢ₊₁ = x⁻ + Kᵢ (z − h(xᵢ) − Hᵢ (x⁻ − xᵢ))      P = (I − KᵢHᵢ) P⁻ (I − KᵢHᵢ)ᵀ + Kᵢ R Kᵢᵀ at the last i

        R stays that of x⁻, as a sum of squares needs one measure; where xᵢ₊₁ predicts no reading, xᵢ is the last.
        What the reading is judged by, ν, S and NIS, comes from the prediction x⁻; H and K are those of the last i.
        """
        x, P = prior
        h, H, R = sensor.linearize(x)
        innovation = sensor.residual(z, h)
        S = innovation_covariance(P, H, R)
        nis, refused = judged(z, h, innovation, S, skip, self.gate)
        σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 0.0))
        K, at, rest = gain(P @ H.mT, S), x, innovation  # rest: z − h(xᵢ) − Hᵢ (x⁻ − xᵢ)
        moving = refused == Refused.NOT
        for _ in range(self.iterations):
            nearer = wrapped(x + np.matvec(K, rest), self.headings)
            moving = moving & np.any(np.abs(nearer - at) > CONVERGED * σ, axis=-1)
            if not np.any(moving):
                break
            h_i, H_i, _ = sensor.linearize(nearer)
            moving = moving & ~np.isnan(h_i).any(axis=-1)
            rest_i = sensor.residual(z, h_i) + np.matvec(H_i, wrapped(nearer - x, self.headings))
            K_i = gain(P @ H_i.mT, innovation_covariance(P, H_i, R))
            at, rest = (np.where(moving[..., None], new, old) for new, old in ((nearer, at), (rest_i, rest)))
            H, K = (np.where(moving[..., None, None], new, old) for new, old in ((H_i, H), (K_i, K)))
        posterior = where_used(refused, revised(Gaussian(x, P), K, H, R, rest, self.headings), Gaussian(x, P))
        return posterior, Correction(h, innovation, R, S, H, K, nis, refused)
