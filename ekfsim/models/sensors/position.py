"""The position as satellites tell it (document 003)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Quantity, Sensor


@dataclass(frozen=True, slots=True)
class Position(Sensor):
    """z = (x, y) in m, from a state that holds them at `layout.position`."""

    sigma_x: float  # m
    sigma_y: float
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """x, y"""
        return Quantity("x", "m"), Quantity("y", "m")

    def h(self, x: Array) -> Array:
        """h = (x, y) : (…, 2)          eq. 2"""
        return x[..., self.layout.position]

    def H(self, x: Array) -> Array:
        """∂h/∂x : (…, 2, n), ones at x and y"""
        H = np.zeros((*x.shape[:-1], 2, x.shape[-1]))
        for row, column in enumerate(self.layout.position):
            H[..., row, column] = 1
        return H

    def R(self, x: Array) -> Array:
        """diag(σ_x², σ_y²) : (…, 2, 2)"""
        return alike(independent(self.sigma_x, self.sigma_y), x.shape[:-1])
