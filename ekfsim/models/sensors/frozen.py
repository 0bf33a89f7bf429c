"""A sensor that keeps being linearised where the robot was (the listing of document 000)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity, Sensor


@dataclass(frozen=True, slots=True, eq=False)
class Frozen(Sensor):
    """h(at), H(at) and R(at), whatever the estimate has become.

    The listing linearises every marker at the state before the time update (its xM, yM, Phi),
    predictions included; the text (section 3.2) does it at the newest estimate, and again after
    each marker.
    """

    sensor: Sensor
    at: Array  # (…, n)

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """Those of the sensor."""
        return self.sensor.outputs

    def h(self, x: Array) -> Array:
        """The reading that `at` predicts : (…, k)"""
        return self.sensor.h(self._held(x))

    def H(self, x: Array) -> Array:
        """∂h/∂x at `at` : (…, k, n)"""
        return self.sensor.H(self._held(x))

    def R(self, x: Array) -> Array:
        """R at `at` : (…, k, k)"""
        return self.sensor.R(self._held(x))

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h(at), wrapped where it is an angle : (…, k)"""
        return self.sensor.residual(z, h)

    def _held(self, x: Array) -> Array:
        """`at` for every x, of which there may be more than runs: sigma points, particles."""
        held = self.at.reshape(
            *self.at.shape[:-1], *(1,) * (x.ndim - self.at.ndim), self.at.shape[-1]
        )
        return held if held.shape == x.shape else np.broadcast_to(held, x.shape)
