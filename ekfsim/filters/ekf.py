"""The extended Kalman filter."""

from dataclasses import dataclass

import numpy as np

from ekfsim.filters.algebra import gain, innovation_covariance, normalized_square, refusal, symmetric
from ekfsim.filters.belief import Correction, Gaussian, Prediction, Refused
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True)
class EKF:
    """Extended Kalman filter: Thrun, Burgard & Fox, Probabilistic Robotics, 2005, Table 3.3; the assignment's section 3."""

    gate: float | None = None  # probability; a reading whose NIS lies beyond that χ² quantile is refused
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]

    def predict(self, belief: Gaussian, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = f(x, u)      P⁻ = F P Fᵀ + G M Gᵀ + Q          eqs 4, 7; u : (…, m) in the motion's units"""
        x, P = belief
        F, G, M, Q = motion.F(x, u), motion.G(x, u), motion.M(u), motion.Q(u)
        return Gaussian(motion.f(x, u), symmetric(F @ P @ F.mT + G @ M @ G.mT + Q)), Prediction(F, G)

    def update(
        self, prior: Gaussian, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """ν = z − h(x⁻)      S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹          eqs 9, 11; z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻ (I − KH)ᵀ + K R Kᵀ          eq. 10; with this K the same as eq. 12, (I − KH) P⁻

        K = 0 where the reading is refused: the belief stays as it is.
        """
        x, P = prior
        h, H, R = sensor.linearize(x)
        innovation = sensor.residual(z, h)
        S = innovation_covariance(P, H, R)
        nis = normalized_square(innovation, S)
        refused = refusal(z, h, nis, skip, self.gate)
        used = (refused == Refused.NOT)[..., None]
        K = np.where(used[..., None], gain(P, H, S), 0.0)
        ν = np.where(used, innovation, 0.0)
        I_KH = np.eye(P.shape[-1]) - K @ H
        joseph = I_KH @ P @ I_KH.mT + K @ np.where(used[..., None], R, 0.0) @ K.mT  # right for any K
        posterior = Gaussian(self._wrapped(x + np.matvec(K, ν)), symmetric(joseph))
        return posterior, Correction(h, innovation, R, S, H, K, nis, refused)

    def _wrapped(self, x: Array) -> Array:
        for i in self.headings:
            x[..., i] = wrap(x[..., i])
        return x
