"""A counter-example: a filter that is told of a laser's noise by what the laser read. Not to be
localized by.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

from ekfsim.filters.belief import Belief, Correction, Prediction
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.models.sensors.laser_by_reading import by_reading


@dataclass(frozen=True)
class NoiseByReading:
    """Any filter, of whose readings C_v = (ratio · z)² in place of (ratio · h)²."""

    remark: ClassVar[str] = ""
    filter: Filter

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """Around an EKF; around another filter it is put once that has begun."""
        return cls(EKF.begin(beginning))

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Belief, Prediction]:
        """As the filter within."""
        return self.filter.predict(belief, motion, u)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Belief, Correction]:
        """As the filter within, from a sensor that knows its reading beforehand."""
        return self.filter.update(prior, by_reading(sensor, z), z, skip)
