"""The yaw as a compass or a gyroscope tells it (document 001, section III C)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Quantity, Sensor


@dataclass(frozen=True, slots=True)
class Yaw(Sensor):
    """z = ω in rad, the yaw. The robot drives in the direction θ = ω − β          eqs 36, 37

    An absolute yaw (compass) has one β for good: how the body lies to the instrument. A relative
    yaw (gyroscope) is 0 where it was set to 0, so −β is the heading that the robot had there.
    """

    orientation: float  # rad, β
    sigma: float  # rad
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """ω"""
        return (Quantity("yaw", "rad"),)

    def h(self, x: Array) -> Array:
        """ω = θ + β : (…, 1)          eqs 36, 37"""
        return wrap(x[..., self.layout.heading, None] + self.orientation)

    def H(self, x: Array) -> Array:
        """∂ω/∂x : (…, 1, n), one at θ"""
        H = np.zeros((*x.shape[:-1], 1, x.shape[-1]))
        H[..., 0, self.layout.heading] = 1
        return H

    def R(self, x: Array) -> Array:
        """σ² : (…, 1, 1)"""
        return alike(independent(self.sigma), x.shape[:-1])

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, wrapped : (…, 1)"""
        return wrap(z - h)
