"""The extended Kalman filter."""

import math
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters import unrolled
from ekfsim.filters.algebra import ROUNDING, innovation_covariance, refusal_one, settled, symmetric, wrapped
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction, Refused
from ekfsim.filters.correcting import Linearized, corrected
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True)
class EKF:
    """Extended Kalman filter: Thrun, Burgard & Fox, Probabilistic Robotics, 2005, Table 3.3; assignment, section 3."""

    remark: ClassVar[str] = ""
    gate: float | None = None  # probability; a reading whose NIS lies beyond that χ² quantile is refused
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = f(x, u)      P⁻ = F P Fᵀ + G M Gᵀ + Q          eqs 4, 7; u : (…, m) in the motion's units"""
        x, P = belief
        f, F, G, M, Q = motion.linearize(x, u)
        P_new = unrolled.predicted(P, F, G, M, Q) if F.ndim == 3 else None
        if P_new is None:
            P_new = symmetric(F @ P @ F.mT + G @ M @ G.mT + Q)
        return Gaussian(f, P_new), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """ν = z − h(x⁻)      S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹          eqs 9, 11; z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻ (I − KH)ᵀ + K R Kᵀ          eq. 10; for this K eq. 12, (I − KH) P⁻

        Where the reading is refused the belief stays as it is; ν, S, K and NIS are told all the same.
        """
        x, P = prior
        h, H, R = sensor.linearize(x)
        reading = Linearized(z, h, sensor.residual(z, h), H, R)
        if z.shape == (1,) and x.ndim == 1:
            return self._update_one(Gaussian(x, P), reading, bool(skip))
        if unrolled.knows(x, z, H) and len(self.headings) == 1:
            return unrolled.updated(Gaussian(x, P), reading, skip, self.gate, self.headings[0])
        return corrected(Gaussian(x, P), reading, skip, self.gate, self.headings)

    def _update_one(self, prior: Gaussian, reading: Linearized, skip: bool) -> tuple[Gaussian, Correction]:
        """The same for one robot and one number: no masks, a third of the time, held equal to the above by a test."""
        (x, P), (z, h, ν, H, R) = prior, reading
        H_row, r = H[0], float(R[0, 0])
        PHt = P @ H_row
        s = float(H_row @ PHt)
        if s > 2 * ROUNDING * float(H_row @ H_row) * float(P.trace()):  # no smaller than what may be rounding
            s += r
        else:
            s = float(innovation_covariance(P, H, R)[0, 0])
        nis = float(ν[0]) ** 2 / s if s > 0 else math.nan
        refused = refusal_one(z, h, nis, skip, self.gate)
        posterior, k = prior, PHt / s if s > 0 else np.zeros_like(x)
        if refused is Refused.NOT and s > 0:
            I_KH_P = P - k[:, None] * PHt
            joseph = I_KH_P - (I_KH_P @ H_row)[:, None] * k + (r * k)[:, None] * k
            P_new = symmetric(joseph)
            if r <= 10 * ROUNDING * s:  # no variance falls by more than S/R
                P_new = settled(P_new, P)
            posterior = Gaussian(wrapped(x + k * ν, self.headings), P_new)
        return posterior, Correction(h, ν, R, np.array([[s]]), H, k[:, None], np.array(nis), np.array(int(refused)))
