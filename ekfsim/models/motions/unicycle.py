"""A robot whose speed and turn rate are told, or its way and turn since the last time.

No document prints it. Both drive their way by the mid-point rule. Their noise grows with the time:
the errors of way and heading after t s are density · √t.
"""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.motions.midpoint import arrival, by_state, by_way
from ekfsim.models.noise import per_second
from ekfsim.models.protocols import Motion, Quantity
from ekfsim.twins import twinned


@dataclass(frozen=True, slots=True)
class Unicycle(Motion):
    """x = (x, y, θ) in m, m, rad; u = (v, ω, dt) in m/s, rad/s, s."""

    distance_density: float  # m per √s
    heading_density: float  # rad per √s

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """v, ω, dt"""
        return Quantity("speed", "m/s"), Quantity("turn rate", "rad/s"), Quantity("dt", "s")

    @twinned
    def f(self, x: Array, u: Array) -> Array:
        """(x + v dt cos(θ + ω dt/2),  y + v dt sin(θ + ω dt/2),  θ + ω dt)"""
        return arrival(x, *self._way(u))

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 3, 3)"""
        return by_state(x, *self._way(u))

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 3, 3) by way and turn, D = v dt and T = ω dt:

        ∂f/∂v = ∂f/∂D · dt        ∂f/∂ω = ∂f/∂T · dt        ∂f/∂dt = ∂f/∂D · v + ∂f/∂T · ω
        """
        J, v, ω, dt = by_way(x, *self._way(u)), u[..., 0, None], u[..., 1, None], u[..., 2, None]
        return np.stack([J[..., 0] * dt, J[..., 1] * dt, J[..., 0] * v + J[..., 1] * ω], axis=-1)

    def M(self, u: Array) -> Array:
        """diag(density_d²/dt, density_θ²/dt, 0) : (…, 3, 3), 0 where no time has passed"""
        rate = per_second(u[..., 2])
        M = np.zeros((*rate.shape, 3, 3))
        M[..., 0, 0] = self.distance_density**2 * rate
        M[..., 1, 1] = self.heading_density**2 * rate
        return M

    def Q(self, u: Array) -> float:
        """All noise enters with u."""
        return 0.0

    def _way(self, u: Array) -> tuple[Array, Array]:
        """D = v dt      T = ω dt"""
        return u[..., 0] * u[..., 2], u[..., 1] * u[..., 2]


@dataclass(frozen=True, slots=True)
class Stride(Motion):
    """x = (x, y, θ) in m, m, rad; u = (D, T, dt) in m, rad, s: way and turn since the last time."""

    distance_density: float  # m per √s
    heading_density: float  # rad per √s

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """D, T, dt"""
        return Quantity("distance", "m"), Quantity("turn", "rad"), Quantity("dt", "s")

    def f(self, x: Array, u: Array) -> Array:
        """(x + D cos(θ + T/2),  y + D sin(θ + T/2),  θ + T)"""
        return arrival(x, u[..., 0], u[..., 1])

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 3, 3)"""
        return by_state(x, u[..., 0], u[..., 1])

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 3, 3); the time enters the noise alone"""
        J = by_way(x, u[..., 0], u[..., 1])
        return np.concatenate([J, np.zeros_like(J[..., :1])], axis=-1)

    def M(self, u: Array) -> Array:
        """diag(density_d² dt, density_θ² dt, 0) : (…, 3, 3)"""
        M = np.zeros((*u.shape[:-1], 3, 3))
        M[..., 0, 0] = self.distance_density**2 * u[..., 2]
        M[..., 1, 1] = self.heading_density**2 * u[..., 2]
        return M

    def Q(self, u: Array) -> float:
        """All noise enters with u."""
        return 0.0
