"""The linearised Kalman filter, on models that are linearised along a way which is known
beforehand.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Self

from ekfsim.filters.belief import Belief, Correction, Prediction
from ekfsim.filters.kf import KF
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True, slots=True)
class Underway:
    """A Gaussian, and how many motion inputs led to it: so far along the nominal trajectory it
    is.
    """

    mean: Array  # (…, n)
    covariance: Array  # (…, n, n)
    inputs: int

    def __iter__(self) -> Iterator[Array]:
        """`x, P = belief` takes any kind of belief."""
        return iter((self.mean, self.covariance))


@dataclass(frozen=True)
class NominalKF:
    """Linearised Kalman filter about a nominal trajectory: Gelb, Applied Optimal Estimation, 1974,
    section 6.1.

    x̄₀, x̄₁, … is where the state would be by plan, with neither noise nor a wrong start. After k
    motion inputs f and h are known by their tangents there, which need no estimate and can be
    worked out before the robot starts:

        f(x, u) ≈ f(x̄ₖ, u) + F(x̄ₖ, u) (x − x̄ₖ)      h(x) ≈ h(x̄ₖ) + H(x̄ₖ) (x − x̄ₖ)

    A wrong estimate cannot spoil them, as it can the EKF's; a robot that leaves its plan does.
    """

    remark: ClassVar[str] = (
        "linearised about the nominal trajectory: the way as it is planned, driven without noise"
    )
    trajectory: Array  # x̄ : (T + 1, n), before, between and after the T motion inputs of the plan
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        assert beginning.nominal is not None
        return cls(beginning.nominal(), beginning.gate, beginning.headings)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Underway, Prediction]:
        """x⁻ = f(x̄ₖ, u) + F (x − x̄ₖ)      P⁻ = F P Fᵀ + G M Gᵀ + Q          u : (…, m)"""
        k = inputs_of(belief)
        (x, P), prediction = self._about(k).predict(belief, motion, u)
        return Underway(x, P, k + 1), prediction

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Underway, Correction]:
        """ν = z − h(x̄ₖ) − H (x⁻ − x̄ₖ)      S = H P⁻ Hᵀ + R      K = P⁻ Hᵀ S⁻¹          z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻
        """
        k = inputs_of(prior)
        (x, P), correction = self._about(k).update(prior, sensor, z, skip)
        return Underway(x, P, k), correction

    def _about(self, k: int) -> KF:
        """The Kalman filter of the models' tangents at x̄ₖ, at the end of the plan once it is
        over.
        """
        return KF(self.trajectory[min(k, len(self.trajectory) - 1)], self.gate, self.headings)


def inputs_of(belief: Belief) -> int:
    """How many motion inputs led to a belief; none to the one that a run begins with."""
    return belief.inputs if isinstance(belief, Underway) else 0
