"""The linear Kalman filter, on models that are linearised once."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters.algebra import wrapped
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.conditioning import covariance
from ekfsim.filters.correcting import Linearized, corrected
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor, angles


@dataclass(frozen=True)
class KF:
    """Linear Kalman filter: Tamás et al., section II.A (document 001's LKF); Thrun, Burgard & Fox,
    2005, Table 3.1.

    It knows a motion and a sensor only by their tangents at one state x₀, the mean of the first
    belief, however far the robot goes from there:

        f(x, u) ≈ f(x₀, u) + F(x₀, u) (x − x₀)      h(x) ≈ h(x₀) + H(x₀) (x − x₀)
        G, M, Q and R as they are at x₀

    Where f and h are linear this is exact. Where they are not, each turn of the robot makes it
    worse.
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
        """x⁻ = f(x₀, u) + F (x − x₀)      P⁻ = F P Fᵀ + G M Gᵀ + Q          eqs 7, 8; u : (…, m)"""
        x, P = belief
        f, F, G, M, Q = motion.linearize(self.about, u)
        mean = wrapped(f + np.matvec(F, self._way(x)), self.headings)
        return Gaussian(mean, covariance(F @ P @ F.mT + G @ M @ G.mT + Q)), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """ν = z − h(x₀) − H (x⁻ − x₀)      S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹
        eq. 9; z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻          eqs 10, 11

        Where the reading is refused the belief stays as it is; ν, S, K and NIS are told all the
        same.
        """
        x, P = prior
        h, H, R = sensor.linearize(self.about)
        predicted = wrapped(h + np.matvec(H, self._way(x)), angles(sensor.outputs))
        reading = Linearized(z, predicted, sensor.residual(z, predicted), H, R)
        posterior, correction = corrected(Gaussian(x, P), reading, skip, self.gate, self.headings)
        return posterior, replace(correction, tangent=True)

    def _way(self, x: Array) -> Array:
        """x − x₀ : (…, n), headings wrapped"""
        return wrapped(x - self.about, self.headings)
