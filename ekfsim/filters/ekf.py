"""The extended Kalman filter."""

from dataclasses import dataclass
from typing import ClassVar, Self

from ekfsim.filters import unrolled
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.conditioning import covariance
from ekfsim.filters.correcting import Linearized, corrected
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True)
class EKF:
    """Extended Kalman filter: Thrun, Burgard & Fox, Probabilistic Robotics, 2005, Table 3.3;
    assignment, section 3.
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
        P_new = unrolled.predicted(P, F, G, M, Q) if F.ndim == 3 else None
        if P_new is None:
            P_new = covariance(F @ P @ F.mT + G @ M @ G.mT + Q)
        return Gaussian(f, P_new), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """ν = z − h(x⁻)      S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹          eqs 9, 11; z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻          eqs 10, 12

        Where the reading is refused the belief stays as it is; ν, S, K and NIS are told all the
        same.
        """
        x, P = prior
        h, H, R = sensor.linearize(x)
        reading = Linearized(z, h, sensor.residual(z, h), H, R)
        if unrolled.knows(x, z, H) and len(self.headings) == 1:
            return unrolled.updated(Gaussian(x, P), reading, skip, self.gate, self.headings[0])
        return corrected(Gaussian(x, P), reading, skip, self.gate, self.headings)
