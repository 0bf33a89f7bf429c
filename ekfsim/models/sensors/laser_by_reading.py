"""The laser whose noise is taken from what it read: a counter-example to the one in laser.py."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Alternatives, Sensor
from ekfsim.models.sensors.laser import Laser


@dataclass(frozen=True, slots=True)
class LaserByReading(Laser):
    """A laser for one reading z, whose C_v is that reading's own."""

    z: Array  # (…, 1) m, nan where there is no echo

    def R(self, x: Array) -> Array:
        """C_v = (ratio · z)² : (…, 1, 1)

        x may have an axis more than z, of sigma points or particles. Without an echo there is no z
        to take it from: there it is the laser's.
        """
        h = self.h(x)
        z = self.z.reshape(*self.z.shape[:-1], *(1,) * (h.ndim - self.z.ndim), 1)
        r = np.where(np.isnan(h) | np.isnan(z), h, z)
        return np.square(self.range_ratio * r)[..., None]

    def alternatives(self, x: Array, P: Array) -> Alternatives | None:
        """None: what is read of other walls has no noise before it is read."""
        return None


def by_reading(sensor: Sensor, z: Array) -> Sensor:
    """The same sensor with its noise by a reading z, where it is a laser; another as it is."""
    if not isinstance(sensor, Laser):
        return sensor
    return LaserByReading(sensor.walls, sensor.bearing, sensor.range_ratio, z)
