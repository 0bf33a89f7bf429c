"""A landmark seen by a lidar, and turned into the global frame by the yaw (document 004)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.noise import independent
from ekfsim.models.protocols import Quantity, Sensor


def to_global(z: Array, θ: Array | float) -> Array:
    """From the lidar's frame, x to the right and y ahead, to the global one.

    Eq. 8, corrected:

        x_p = x_L sin θ + y_L cos θ        y_p = −x_L cos θ + y_L sin θ
        z : (…, 2) m, θ : (…) rad → (…, 2) m

    Eq. 8 is printed with θ where π/2 − θ belongs; the authors' code turns by π/2 − θ.

    >>> to_global(np.array([0.0, 7.0]), 0.0).tolist()  # ahead of a robot that looks east
    [7.0, 0.0]
    """
    right, ahead, s, c = z[..., 0], z[..., 1], np.sin(θ), np.cos(θ)
    return np.stack([right * s + ahead * c, -right * c + ahead * s], axis=-1)


def from_global(z: Array, θ: Array | float) -> Array:
    """What `to_global` turned, turned back into the lidar's frame : (…, 2) m

    >>> from_global(np.array([7.0, 0.0]), 0.0).tolist()
    [0.0, 7.0]
    """
    east, north, s, c = z[..., 0], z[..., 1], np.sin(θ), np.cos(θ)
    return np.stack([east * s - north * c, east * c + north * s], axis=-1)


def to_global_as_printed(z: Array, θ: Array | float) -> Array:
    """Eq. 8 to the letter, wrong for its lidar's frame.

    x_p = x_L cos θ + y_L sin θ        y_p = −x_L sin θ + y_L cos θ
    """
    right, ahead, s, c = z[..., 0], z[..., 1], np.sin(θ), np.cos(θ)
    return np.stack([right * c + ahead * s, -right * s + ahead * c], axis=-1)


@dataclass(frozen=True, slots=True)
class LandmarkOffset(Sensor):
    """z = the landmark's place less the robot's, in m east and m north."""

    x: float  # m, X_L
    y: float  # m, Y_L
    sigma_x: float  # m
    sigma_y: float
    layout: Layout = POSE
    yaw_sigma: float = 0.0  # rad, of the yaw that turned the reading; the document leaves it out

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """x_p, y_p"""
        return Quantity("east", "m"), Quantity("north", "m")

    def h(self, x: Array) -> Array:
        """h = (X_L − x, Y_L − y) : (…, 2)          eq. 9"""
        return np.array([self.x, self.y]) - x[..., self.layout.position]

    def H(self, x: Array) -> Array:
        """∂h/∂x : (…, 2, n), −1 at x and y"""
        H = np.zeros((*x.shape[:-1], 2, x.shape[-1]))
        for row, column in enumerate(self.layout.position):
            H[..., row, column] = -1
        return H

    def R(self, x: Array) -> Array:
        """diag(σ_x², σ_y²) + σ_θ² J Jᵀ          J = ∂z/∂θ = (−h_y, h_x) : (…, 2, 2)

        Eq. 10 has the first part only: an error of the yaw times the lever arm to the landmark is
        the second.
        """
        h = self.h(x)
        J = self.yaw_sigma * np.stack([-h[..., 1], h[..., 0]], axis=-1)
        return independent(self.sigma_x, self.sigma_y) + J[..., :, None] * J[..., None, :]
