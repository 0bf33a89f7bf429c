"""An ultrasonic beam to the first wall, less certain the further that is (document 001, section IV
B).
"""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls


@dataclass(frozen=True, slots=True)
class UltrasonicBeam(Sensor):
    """A beam `bearing` rad from straight ahead, counter-clockwise, from x = (x, y, θ) in m, m,
    rad.
    """

    walls: Walls
    bearing: float  # rad
    sigma: float  # m, at no distance
    sigma_per_metre: float  # and per m of distance, as fig. 6 has it grow
    nearest: float = 0.1  # m; the document measures from 10 to 200 cm
    farthest: float = 2.0

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One range."""
        return (Quantity("range", "m"),)

    def h(self, x: Array) -> Array:
        """r = the distance to the first wall : (…, 1) m, nan where none stands between `nearest`
        and `farthest`
        """
        return self.linearize(x)[0]

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 1), H (…, 1, 3) as the laser's, and R = (σ + σ_r r)² (…, 1, 1)."""
        r, H, _ = self._beam().linearize(x)
        heard = (r >= self.nearest) & (r <= self.farthest)
        r = np.where(heard, r, np.nan)
        return (
            r,
            np.where(heard[..., None], H, 0.0),
            (self.sigma + self.sigma_per_metre * r[..., None]) ** 2,
        )

    def _beam(self) -> Laser:
        return Laser(self.walls, self.bearing, 0.0)
