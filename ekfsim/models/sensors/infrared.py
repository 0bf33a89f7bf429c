"""Infrared light that a wall sends back, the more the nearer it is (document 001, fig. 4)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls

COLOURS: dict[str, float] = {  # reflectances; fig. 4 tells that they matter, and prints no numbers
    "white": 1.0,
    "yellow": 0.9,
    "red": 0.8,
    "grey": 0.6,
    "blue": 0.5,
    "green": 0.45,
    "black": 0.25,
}


@dataclass(frozen=True, slots=True)
class InfraredBeam(Sensor):
    """A pair of emitter and receiver that look `bearing` rad from straight ahead.

    x = (x, y, θ) in m, m, rad.
    """

    walls: Walls
    bearing: float  # rad
    gain: float  # V per e-fold of the distance, from white
    offset: float  # V at 1 m, from white
    reflectance: float  # of the walls, 1 where they are white
    sigma: float  # V
    nearest: float = 0.1  # m, more than 0
    farthest: float = 1.5

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One intensity."""
        return (Quantity("intensity", "V"),)

    def h(self, x: Array) -> Array:
        """I = ρ (offset − gain ln r) : (…, 1) V

        ρ is the reflectance; the almost logarithmic dependency is section IV A's. nan where no wall
        stands between `nearest` and `farthest`.
        """
        return self.reflectance * (self.offset - self.gain * np.log(self._range(x)))

    def H(self, x: Array) -> Array:
        """∂I/∂x = −ρ gain/r · ∂r/∂x : (…, 1, 3), with the laser's ∂r/∂x; 0 where no wall is lit"""
        r = self._range(x)[..., None]
        slope = -self.reflectance * self.gain / np.where(np.isnan(r), 1.0, r)
        return np.where(np.isnan(r), 0.0, slope * self._beam().H(x))

    def R(self, x: Array) -> Array:
        """σ² : (…, 1, 1)"""
        return np.where(np.isnan(self._range(x)), np.nan, self.sigma**2)[..., None]

    def _range(self, x: Array) -> Array:
        """r, the distance to the wall that is lit : (…, 1) m, nan where there is none"""
        r = self._beam().h(x)
        return np.where((r >= self.nearest) & (r <= self.farthest), r, np.nan)

    def _beam(self) -> Laser:
        return Laser(self.walls, self.bearing, 0.0)
