"""A robot whose speed and turn rate are told, or its way and turn since the last time; no document prints it.

Both drive their way at the heading in the middle of the turn, as eqs 16 to 18 of document 000 do. Their noise grows
with the time: the errors of way and heading after t s are density · √t.
"""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap, wrap_one
from ekfsim.models.protocols import Quantity


def _arrival(x: Array, distance: Array, turn: Array) -> Array:
    """(x + D cos(θ + T/2),  y + D sin(θ + T/2),  θ + T)"""
    middle = x[..., 2] + turn / 2
    return np.stack(
        [x[..., 0] + distance * np.cos(middle), x[..., 1] + distance * np.sin(middle), wrap(x[..., 2] + turn)], axis=-1
    )


def _by_state(x: Array, distance: Array, turn: Array) -> Array:
    """∂/∂x : (…, 3, 3)"""
    middle = x[..., 2] + turn / 2
    J = np.zeros((*middle.shape, 3, 3))
    J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = 1
    J[..., 0, 2] = -distance * np.sin(middle)
    J[..., 1, 2] = distance * np.cos(middle)
    return J


def _by_way(x: Array, distance: Array, turn: Array) -> Array:
    """∂/∂(D, T, dt), of which dt moves nothing : (…, 3, 3)"""
    middle = x[..., 2] + turn / 2
    J = np.zeros((*middle.shape, 3, 3))
    J[..., 0, 0] = np.cos(middle)
    J[..., 1, 0] = np.sin(middle)
    J[..., 0, 1] = -distance * np.sin(middle) / 2
    J[..., 1, 1] = distance * np.cos(middle) / 2
    J[..., 2, 1] = 1
    return J


@dataclass(frozen=True, slots=True)
class Unicycle:
    """x = (x, y, θ) in m, m, rad; u = (v, ω, dt) in m/s, rad/s, s."""

    distance_density: float  # m per √s
    heading_density: float  # rad per √s

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """v, ω, dt"""
        return Quantity("speed", "m/s"), Quantity("turn rate", "rad/s"), Quantity("dt", "s")

    def f(self, x: Array, u: Array) -> Array:
        """(x + v dt cos(θ + ω dt/2),  y + v dt sin(θ + ω dt/2),  θ + ω dt)"""
        if x.ndim == u.ndim == 1:
            (px, py, θ), (v, ω, dt) = x.tolist(), u.tolist()
            middle = θ + ω * dt / 2
            return np.array([px + v * dt * math.cos(middle), py + v * dt * math.sin(middle), wrap_one(θ + ω * dt)])
        return _arrival(x, *_way(u))

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 3, 3)"""
        return _by_state(x, *_way(u))

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 3, 3) by way and turn, D = v dt and T = ω dt:

        ∂f/∂v = ∂f/∂D · dt        ∂f/∂ω = ∂f/∂T · dt        ∂f/∂dt = ∂f/∂D · v + ∂f/∂T · ω
        """
        J, v, ω, dt = _by_way(x, *_way(u)), u[..., 0, None], u[..., 1, None], u[..., 2, None]
        return np.stack([J[..., 0] * dt, J[..., 1] * dt, J[..., 0] * v + J[..., 1] * ω], axis=-1)

    def M(self, u: Array) -> Array:
        """diag(density_d²/dt, density_θ²/dt, 0) : (…, 3, 3), 0 where no time has passed"""
        dt = u[..., 2]
        per_second = np.divide(1.0, dt, out=np.zeros_like(dt), where=dt > 0)
        M = np.zeros((*dt.shape, 3, 3))
        M[..., 0, 0] = self.distance_density**2 * per_second
        M[..., 1, 1] = self.heading_density**2 * per_second
        return M

    def Q(self, u: Array) -> float:
        """All noise enters with u."""
        return 0.0

    def linearize(self, x: Array, u: Array) -> tuple[Array, Array, Array, Array, float]:
        """f, F, G, M and Q at once."""
        if x.ndim == u.ndim == 1:
            return self._linearize_one(*x.tolist(), *u.tolist())
        return self.f(x, u), self.F(x, u), self.G(x, u), self.M(u), 0.0

    def _linearize_one(
        self, x: float, y: float, θ: float, v: float, ω: float, dt: float
    ) -> tuple[Array, Array, Array, Array, float]:
        """The same for one robot in plain floats: several times as fast, held equal to the above by a test."""
        middle, per_second = θ + ω * dt / 2, 1 / dt if dt > 0 else 0.0
        c, s = math.cos(middle), math.sin(middle)
        dx, dy, h = v * dt * c, v * dt * s, dt / 2
        return (
            np.array([x + dx, y + dy, wrap_one(θ + ω * dt)]),
            np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]]),
            np.array([[c * dt, -dy * h, v * c - dy * ω / 2], [s * dt, dx * h, v * s + dx * ω / 2], [0.0, dt, ω]]),
            np.diag([self.distance_density**2 * per_second, self.heading_density**2 * per_second, 0.0]),
            0.0,
        )


def _way(u: Array) -> tuple[Array, Array]:
    """D = v dt      T = ω dt"""
    return u[..., 0] * u[..., 2], u[..., 1] * u[..., 2]


@dataclass(frozen=True, slots=True)
class Stride:
    """x = (x, y, θ) in m, m, rad; u = (D, T, dt) in m, rad, s: way and turn since the last time."""

    distance_density: float  # m per √s
    heading_density: float  # rad per √s

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """D, T, dt"""
        return Quantity("distance", "m"), Quantity("turn", "rad"), Quantity("dt", "s")

    def f(self, x: Array, u: Array) -> Array:
        """(x + D cos(θ + T/2),  y + D sin(θ + T/2),  θ + T)"""
        return _arrival(x, u[..., 0], u[..., 1])

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 3, 3)"""
        return _by_state(x, u[..., 0], u[..., 1])

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 3, 3); the time enters the noise alone"""
        return _by_way(x, u[..., 0], u[..., 1])

    def M(self, u: Array) -> Array:
        """diag(density_d² dt, density_θ² dt, 0) : (…, 3, 3)"""
        M = np.zeros((*u.shape[:-1], 3, 3))
        M[..., 0, 0] = self.distance_density**2 * u[..., 2]
        M[..., 1, 1] = self.heading_density**2 * u[..., 2]
        return M

    def Q(self, u: Array) -> float:
        """All noise enters with u."""
        return 0.0

    def linearize(self, x: Array, u: Array) -> tuple[Array, Array, Array, Array, float]:
        """f, F, G, M and Q at once."""
        return self.f(x, u), self.F(x, u), self.G(x, u), self.M(u), 0.0
