"""The linear Kalman filter, on models that are linearised once."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor, angles


@dataclass(frozen=True)
class KF:
    """Linear Kalman filter: Tamás et al., section II.A (document 001's LKF); Thrun, Burgard & Fox,
    2005, Table 3.1.

    It knows a motion and a sensor only by their tangents at one state x₀, the mean of the first
    belief, however far the robot goes from there; G, M, Q and R are as they are at x₀. Where f and
    h are linear this is exact. Where they are not, each turn of the robot makes it worse.
    """

    remark: ClassVar[str] = "linearised once, at the first belief"
    about: Array  # x₀ : (…, n)
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.first.mean, beginning.gate, beginning.headings)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = f(x₀, u) + F (x − x₀)      P⁻ = F P Fᵀ + G M Gᵀ + Q          u : (…, m)"""
        x, P = belief
        f, F, G, M, Q = motion.linearize(self.about, u)
        mean = wrapped(f + np.matvec(F, wrapped(x - self.about, self.headings)), self.headings)
        return Gaussian(mean, kalman.predict(P, F, G, M, Q)), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """ν = z − h(x₀) − H (x⁻ − x₀), then as in the EKF          z : (…, k)"""
        x, P = prior
        h, H, R = sensor.linearize(self.about)
        h = h + np.matvec(H, wrapped(x - self.about, self.headings))
        h = wrapped(h, angles(sensor.outputs))
        reading = kalman.Linearized(z, h, sensor.residual(z, h), H, R)
        posterior, told = kalman.update(
            Gaussian(x, P), reading, kalman.Rule(self.gate, skip, self.headings)
        )
        return posterior, replace(told, tangent=True)
