"""A counter-example: a filter that keeps of P what ellipse and cone show of it. Not to be localized
by.
"""

import dataclasses
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


@dataclass(frozen=True)
class ShadowsAlone:
    """Any filter of a pose, P with σ_xθ = σ_yθ = 0 after every step: position and heading as if
    they erred apart.
    """

    remark: ClassVar[str] = ""
    filter: Filter

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """Around an EKF; around another filter it is put once that has begun."""
        return cls(EKF.begin(beginning))

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Belief, Prediction]:
        """P⁻ of the filter within, its two cross covariances dropped."""
        after, prediction = self.filter.predict(belief, motion, u)
        return shadows(after), prediction

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Belief, Correction]:
        """P of the filter within, its two cross covariances dropped."""
        after, correction = self.filter.update(prior, sensor, z, skip)
        return shadows(after), correction


def shadows(belief: Belief) -> Belief:
    """The belief without σ_xθ and σ_yθ : (…, 3), (…, 3, 3); whatever else it knows stays."""
    P = belief.covariance.copy()
    P[..., :2, 2] = P[..., 2, :2] = 0.0
    if isinstance(belief, Gaussian):
        return belief._replace(covariance=P)
    known: Any = belief
    dropped: Belief = dataclasses.replace(known, covariance=P)
    return dropped
