"""The filter of the listings of documents 000 and 003, where they differ from the text."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Self

from ekfsim.filters.belief import Belief, Correction, Prediction
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.models.sensors.frozen import Frozen


@dataclass(frozen=True, slots=True)
class Remembering:
    """A Gaussian belief that knows where the robot was believed to be before the last motion."""

    mean: Array  # (…, n)
    covariance: Array  # (…, n, n)
    before: Array  # (…, n)

    def __iter__(self) -> Iterator[Array]:
        """`x, P = belief` takes any kind of belief."""
        return iter((self.mean, self.covariance))


@dataclass(frozen=True)
class ListingEKF:
    """An EKF that linearises every marker where the robot stood before the time update.

    The listing keeps xM, yM and Phi from before the time update and never refreshes them, so the
    markers of one instant are all held against the same stale prediction; section 3.2 linearises at
    the newest estimate. The authors of document 003 take the innovation of their fixes in the same
    way.
    """

    remark: ClassVar[str] = (
        "it holds each reading against where the robot stood before the last motion input"
    )
    ekf: EKF

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(EKF.begin(beginning))

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Remembering, Prediction]:
        """As the EKF does, keeping xM, yM, Phi."""
        (x, P), prediction = self.ekf.predict(belief, motion, u)
        return Remembering(x, P, belief.mean), prediction

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Remembering, Correction]:
        """As the EKF does, but ν = z − h(x before the motion) and H is taken there, too."""
        before = prior.before if isinstance(prior, Remembering) else prior.mean
        (x, P), correction = self.ekf.update(prior, Frozen(sensor, before), z, skip)
        return Remembering(x, P, before), correction
