"""The classroom's motion: straight ahead by d, then a turn in place by a (assignment, 3.1)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import Motion, Quantity
from ekfsim.twins import twinned


@dataclass(frozen=True, slots=True)
class MoveTurn(Motion):
    """x = (x, y, θ) in m, m, rad; u = (d, a) in m, rad, as the odometry measured them.

    The σ of each is proportional to it.
    """

    distance_ratio: float
    angle_ratio: float

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """d, a"""
        return Quantity("distance", "m"), Quantity("angle", "rad")

    @twinned
    def f(self, x: Array, u: Array) -> Array:
        """Φ(x, u) = (x + d cos θ,  y + d sin θ,  θ + a)          eq. 3"""
        θ, d, a = x[..., 2], u[..., 0], u[..., 1]
        after = x[..., 0] + d * np.cos(θ), x[..., 1] + d * np.sin(θ), wrap(θ + a)
        return np.stack(after, axis=-1)

    def F(self, x: Array, u: Array) -> Array:
        """J_x = ∂Φ/∂x : (…, 3, 3)          eq. 6

        Only the heading bends the way: ∂x/∂θ = −d sin θ, ∂y/∂θ = d cos θ
        """
        θ, d = x[..., 2], u[..., 0]
        J = np.zeros((*np.broadcast_shapes(θ.shape, d.shape), 3, 3))
        J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = 1
        J[..., 0, 2] = -d * np.sin(θ)
        J[..., 1, 2] = d * np.cos(θ)
        return J

    def G(self, x: Array, u: Array) -> Array:
        """J_u = ∂Φ/∂u : (…, 3, 2)          eq. 6

        At the heading before the turn: the robot drives first.
        """
        θ = x[..., 2]
        J = np.zeros((*np.broadcast_shapes(θ.shape, u.shape[:-1]), 3, 2))
        J[..., 0, 0] = np.cos(θ)
        J[..., 1, 0] = np.sin(θ)
        J[..., 2, 1] = 1
        return J

    def M(self, u: Array) -> Array:
        """P_u = diag((ratio_d d)², (ratio_a a)²) : (…, 2, 2)          eq. 1"""
        P = np.zeros((*u.shape[:-1], 2, 2))
        P[..., 0, 0] = (self.distance_ratio * u[..., 0]) ** 2
        P[..., 1, 1] = (self.angle_ratio * u[..., 1]) ** 2
        return P

    def Q(self, u: Array) -> float:
        """The assignment has no process noise w(k): all noise enters with u."""
        return 0.0
