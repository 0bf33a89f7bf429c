"""A planar inertial unit that drives a state of seven (document 004, section II)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.noise import alike, independent, per_second
from ekfsim.models.protocols import Motion, Quantity


@dataclass(frozen=True, slots=True)
class PlanarImu(Motion):
    """x = (ẋ, x, ẏ, y, θ̇, θ, θ_p) in m/s, m, m/s, m, rad/s, rad, rad, all global.

    u = (a_x, a_y, yaw, dt): the accelerations are along the robot (a_x) and to its left (a_y) in
    m/s², the yaw is global in rad, dt in s. Eq. 5 prints eight entries on its left, among them a
    θ̇_p: the state has seven.
    """

    forward_sigma: float = 1.8373**0.5  # m/s², of a_x
    lateral_sigma: float = 1.1991**0.5  # m/s², of a_y
    yaw_sigma: float = 0.00058709**0.5  # rad
    # whether θ − θ_p goes the short way round; the authors' code lets it jump by 2π
    wrapped: bool = True
    # −1: a_y in ẏ with the minus that eq. 5 prints, and eq. 7 contradicts
    lateral_sign: float = 1.0

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """a_x, a_y, yaw, dt"""
        forward, lateral = (
            Quantity("forward acceleration", "m/s²"),
            Quantity("lateral acceleration", "m/s²"),
        )
        return forward, lateral, Quantity("yaw", "rad"), Quantity("dt", "s")

    def f(self, x: Array, u: Array) -> Array:
        """The next state; on the right are old values throughout.          eq. 5, with a plus in ẏ

            ẋ = ẋ + (a_x cos yaw − a_y sin yaw) dt        x = x + ẋ dt
            ẏ = ẏ + (a_x sin yaw + a_y cos yaw) dt        y = y + ẏ dt
            θ̇ = (θ − θ_p)/dt        θ = yaw        θ_p = θ

        Where no time has passed (dt = 0), θ̇ stays as it was.
        """
        vx, px, vy, py, ω, θ, _ = np.moveaxis(x, -1, 0)
        ax, ay, yaw, dt = np.moveaxis(u, -1, 0)
        c, s = np.cos(yaw), np.sin(yaw)
        after = (
            vx + (ax * c - ay * s) * dt,
            px + vx * dt,
            vy + (ax * s + self.lateral_sign * ay * c) * dt,
            py + vy * dt,
            np.where(dt > 0, self._turned(x) * per_second(dt), ω),
            wrap(yaw),
            θ,
        )
        return np.stack(np.broadcast_arrays(*after), axis=-1)

    def F(self, x: Array, u: Array) -> Array:
        """G_x = ∂f/∂x : (…, 7, 7)          eq. 6"""
        dt = u[..., 3]
        J = np.zeros((*np.broadcast_shapes(x.shape[:-1], dt.shape), 7, 7))
        J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = J[..., 3, 3] = J[..., 6, 5] = 1
        J[..., 1, 0] = J[..., 3, 2] = dt
        J[..., 4, 4] = dt <= 0
        J[..., 4, 5] = per_second(dt)
        J[..., 4, 6] = -per_second(dt)
        return J

    def G(self, x: Array, u: Array) -> Array:
        """G_u = ∂f/∂u : (…, 7, 4)          eq. 7

        And the row of θ = yaw and the column of dt, which it leaves out. Eq. 7 has the right sign
        whatever `lateral_sign` makes of f: as printed, eqs 5 and 7 do not agree.
        """
        ax, ay, yaw, dt = np.moveaxis(u, -1, 0)
        c, s = np.cos(yaw), np.sin(yaw)
        J = np.zeros((*np.broadcast_shapes(x.shape[:-1], dt.shape), 7, 4))
        J[..., 0, 0] = J[..., 2, 1] = dt * c
        J[..., 0, 1] = -dt * s
        J[..., 2, 0] = dt * s
        J[..., 0, 2] = -(ax * s + ay * c) * dt
        J[..., 2, 2] = (ax * c - ay * s) * dt
        J[..., 5, 2] = 1
        J[..., 0, 3] = ax * c - ay * s
        J[..., 1, 3] = x[..., 0]
        J[..., 2, 3] = ax * s + ay * c
        J[..., 3, 3] = x[..., 2]
        J[..., 4, 3] = -self._turned(x) * per_second(dt) ** 2
        return J

    def M(self, u: Array) -> Array:
        """R_t = diag(σ_ax², σ_ay², σ_θ²), and 0 for dt : (…, 4, 4)          eq. 10"""
        return alike(
            independent(self.forward_sigma, self.lateral_sigma, self.yaw_sigma, 0.0), u.shape[:-1]
        )

    def Q(self, u: Array) -> float:
        """Eq. 1 has no process noise: all noise enters with u."""
        return 0.0

    def _turned(self, x: Array) -> Array:
        """θ − θ_p"""
        turned = x[..., 5] - x[..., 6]
        return wrap(turned) if self.wrapped else turned
