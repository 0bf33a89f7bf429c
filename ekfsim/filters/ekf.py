"""The extended Kalman filter: read this one first, and kalman.py beside it."""

from dataclasses import dataclass
from typing import ClassVar, Self

from ekfsim.filters import kalman
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True)
class EKF:
    """Extended Kalman filter: Thrun, Burgard & Fox, Probabilistic Robotics, 2005, Table 3.3;
    assignment, section 3.

    f and h are linearised at the newest estimate: F = ∂f/∂x, G = ∂f/∂u and H = ∂h/∂x there.
    """

    remark: ClassVar[str] = ""
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = f(x, u)      P⁻ = F P Fᵀ + G M Gᵀ + Q
        eqs 4, 7; u : (…, m) in the motion's units
        """
        x, P = belief
        f, F, G, M, Q = motion.linearize(x, u)
        return Gaussian(f, kalman.predict(P, F, G, M, Q)), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """ν = z − h(x⁻)      S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹          eqs 9, 11; z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻          eqs 10, 12
        """
        x, P = prior
        h, H, R = sensor.linearize(x)
        reading = kalman.Linearized(z, h, sensor.residual(z, h), H, R)
        return kalman.update(Gaussian(x, P), reading, kalman.Rule(self.gate, skip, self.headings))
