"""The classroom's motion: straight ahead by d, then a turn in place by a (the assignment's section
3.1).
"""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim import twins
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap, wrap_one
from ekfsim.geometry.soa import back, lanes
from ekfsim.models.protocols import Motion, Quantity


@dataclass(frozen=True, slots=True)
class MoveTurn(Motion):
    """x = (x, y, θ) in m, m, rad; u = (d, a) in m, rad, as the odometry measured them, σ
    proportional to each.
    """

    distance_ratio: float
    angle_ratio: float

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """d, a"""
        return Quantity("distance", "m"), Quantity("angle", "rad")

    def f(self, x: Array, u: Array) -> Array:
        """Φ(x, u) = (x + d cos θ,  y + d sin θ,  θ + a)          eq. 3"""
        if x.ndim == u.ndim == 1:
            return self._f_one(*x.tolist(), *u.tolist())
        θ, d = x[..., 2], u[..., 0]
        return back(
            np.stack([x[..., 0] + d * np.cos(θ), x[..., 1] + d * np.sin(θ), wrap(θ + u[..., 1])]), 1
        )

    def F(self, x: Array, u: Array) -> Array:
        """J_x = ∂Φ/∂x : (…, 3, 3)
        eq. 6.  Only the heading bends the way: ∂x/∂θ = −d sin θ, ∂y/∂θ = d cos θ
        """
        θ, d = x[..., 2], u[..., 0]
        J = np.zeros((*np.broadcast_shapes(θ.shape, d.shape), 3, 3))
        J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = 1
        J[..., 0, 2] = -d * np.sin(θ)
        J[..., 1, 2] = d * np.cos(θ)
        return J

    def G(self, x: Array, u: Array) -> Array:
        """J_u = ∂Φ/∂u : (…, 3, 2)
        eq. 6.  At the heading before the turn: the robot drives first
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

    def linearize(self, x: Array, u: Array) -> tuple[Array, Array, Array, Array, float]:
        """f, F, G, M and Q at once, the sine and cosine taken once; held equal to the above by a
        test.
        """
        if x.ndim == u.ndim == 1:
            return self._linearize_one(*x.tolist(), *u.tolist())
        if len(x) == len(u) and x.ndim == u.ndim == 2 and twins.taken() == "compiled":
            from ekfsim.models.compiled import moved

            return *moved(x, u, self.distance_ratio, self.angle_ratio), 0.0
        axes = np.broadcast_shapes(x.shape[:-1], u.shape[:-1])
        x_new, F, G, M = lanes(axes, 3), lanes(axes, 3, 3), lanes(axes, 3, 2), lanes(axes, 2, 2)
        θ, d, a = x[..., 2], u[..., 0], u[..., 1]
        c, s = np.cos(θ), np.sin(θ)
        F[..., 0, 0] = F[..., 1, 1] = F[..., 2, 2] = G[..., 2, 1] = 1
        G[..., 0, 0], G[..., 1, 0] = c, s
        F[..., 1, 2] = d * c
        F[..., 0, 2] = -d * s
        x_new[..., 0] = x[..., 0] + F[..., 1, 2]
        x_new[..., 1] = x[..., 1] - F[..., 0, 2]
        x_new[..., 2] = wrap(θ + a)
        M[..., 0, 0] = np.square(self.distance_ratio * d)
        M[..., 1, 1] = np.square(self.angle_ratio * a)
        return x_new, F, G, M, 0.0

    def _f_one(self, x: float, y: float, θ: float, d: float, a: float) -> Array:
        return np.array([x + d * math.cos(θ), y + d * math.sin(θ), wrap_one(θ + a)])

    def _linearize_one(
        self, x: float, y: float, θ: float, d: float, a: float
    ) -> tuple[Array, Array, Array, Array, float]:
        """The same for one robot in plain floats: five times as fast, held equal to the above by a
        test.
        """
        c, s = math.cos(θ), math.sin(θ)
        return (
            self._f_one(x, y, θ, d, a),
            np.array([[1.0, 0.0, -d * s], [0.0, 1.0, d * c], [0.0, 0.0, 1.0]]),
            np.array([[c, 0.0], [s, 0.0], [0.0, 1.0]]),
            np.array([[(self.distance_ratio * d) ** 2, 0.0], [0.0, (self.angle_ratio * a) ** 2]]),
            0.0,
        )
