"""A landmark seen by a lidar and read as it sees it, in the robot's own frame (document 004)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Quantity, Sensor


@dataclass(frozen=True, slots=True)
class LidarOffset(Sensor):
    """z = (x_L, y_L) in m, how far to the right and how far ahead of the robot the landmark stands.

    Document 004 turns this into the global frame by the yaw before its filter reads it
    (models/sensors/offset.py), "so that the uncertainty in yaw is not incorporated into the
    correction". Left as it is read, it corrects the yaw.
    """

    x: float  # m, X_L
    y: float  # m, Y_L
    sigma: float  # m, to the right and ahead
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """x_L, y_L"""
        return Quantity("right", "m"), Quantity("ahead", "m")

    def h(self, x: Array) -> Array:
        """The landmark in the robot's frame : (…, 2)          eq. 8 turned round, with eq. 9 in it

            x_L = Δx sin θ − Δy cos θ
            y_L = Δx cos θ + Δy sin θ

        with Δx = X_L − x and Δy = Y_L − y.
        """
        i, j = self.layout.position
        east, north, θ = self.x - x[..., i], self.y - x[..., j], x[..., self.layout.heading]
        s, c = np.sin(θ), np.cos(θ)
        return np.stack([east * s - north * c, east * c + north * s], axis=-1)

    def H(self, x: Array) -> Array:
        """∂h/∂x : (…, 2, n)

        ∂x_L/∂(x, y) = (−sin θ, cos θ)         ∂x_L/∂θ = y_L
        ∂y_L/∂(x, y) = (−cos θ, −sin θ)        ∂y_L/∂θ = −x_L
        """
        h, θ = self.h(x), x[..., self.layout.heading]
        s, c = np.sin(θ), np.cos(θ)
        (i, j), k = self.layout.position, self.layout.heading
        H = np.zeros((*θ.shape, 2, x.shape[-1]))
        H[..., 0, i], H[..., 0, j], H[..., 0, k] = -s, c, h[..., 1]
        H[..., 1, i], H[..., 1, j], H[..., 1, k] = -c, -s, -h[..., 0]
        return H

    def R(self, x: Array) -> Array:
        """σ² I : (…, 2, 2)"""
        return alike(independent(self.sigma, self.sigma), x.shape[:-1])
