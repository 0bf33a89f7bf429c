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
    """z = ω in rad, the yaw of which eqs 36 and 37 make the direction θ = ω − β in which the robot
    drives.

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

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 1), H (…, 1, n) and R = σ² (…, 1, 1): ω = θ + β, ∂ω/∂θ = 1.          eqs 36, 37"""
        H = np.zeros((*x.shape[:-1], 1, x.shape[-1]))
        H[..., 0, self.layout.heading] = 1
        ω = wrap(x[..., self.layout.heading] + self.orientation)
        return ω[..., None], H, alike(independent(self.sigma), x.shape[:-1])

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, wrapped : (…, 1)"""
        return wrap(z - h)
