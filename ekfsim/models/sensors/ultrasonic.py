"""An ultrasonic beam to the first wall, less certain the further that is (document 001, IV B)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls


@dataclass(frozen=True, slots=True)
class UltrasonicBeam(Sensor):
    """A beam `bearing` rad from straight ahead, counter-clockwise; x = (x, y, θ) in m, m, rad."""

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
        """r = the distance to the first wall : (…, 1) m

        nan where none stands between `nearest` and `farthest`.
        """
        r = self._beam().h(x)
        return np.where((r >= self.nearest) & (r <= self.farthest), r, np.nan)

    def H(self, x: Array) -> Array:
        """∂r/∂x : (…, 1, 3), as the laser's; 0 where there is no echo"""
        heard = ~np.isnan(self.h(x))
        return np.where(heard[..., None], self._beam().H(x), 0.0)

    def R(self, x: Array) -> Array:
        """(σ + σ_r r)² : (…, 1, 1)"""
        return (self.sigma + self.sigma_per_metre * self.h(x)[..., None]) ** 2

    def _beam(self) -> Laser:
        return Laser(self.walls, self.bearing, 0.0)
