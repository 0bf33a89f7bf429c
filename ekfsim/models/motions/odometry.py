"""Odometry of a robot with wheels on its left and on its right (document 001, section III)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Motion, Quantity


@dataclass(frozen=True, slots=True, eq=False)
class ArctanOdometry(Motion):
    """x = (x, y, ω) in m, m, rad; u = (Δd_L, Δd_R) in m, the ways of the wheels (eqs 34, 35)."""

    width: float  # m, W: between the centres of left and right wheels
    wheel_ratio: float  # σ of a wheel's way per m of it
    wheel_floor: float = 0.0  # m, σ of a wheel at rest
    process: Array | float = 0.0  # (3, 3)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """Δd_L, Δd_R"""
        return Quantity("left", "m"), Quantity("right", "m")

    def f(self, x: Array, u: Array) -> Array:
        """(x + d cos ω,  y + d sin ω,  ω + tan⁻¹((Δd_R − Δd_L)/W)) : (…, 3)          eqs 31 to 33

        The way goes along the new ω.
        """
        d, ω = self._way(u), x[..., 2] + self._turn(u)
        return np.stack([x[..., 0] + d * np.cos(ω), x[..., 1] + d * np.sin(ω), wrap(ω)], axis=-1)

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 3, 3)          eqs 12, 31 to 33"""
        d, ω = self._way(u), x[..., 2] + self._turn(u)
        J = np.zeros((*ω.shape, 3, 3))
        J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = 1
        J[..., 0, 2] = -d * np.sin(ω)
        J[..., 1, 2] = d * np.cos(ω)
        return J

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 3, 2)          eqs 31 to 33

        ∂ω/∂Δd_R = −∂ω/∂Δd_L = W/(W² + (Δd_R − Δd_L)²)
        """
        d, ω = self._way(u), x[..., 2] + self._turn(u)
        c, s = np.cos(ω), np.sin(ω)
        per_metre = 1 / (self.width * (1 + self._ratio(u) ** 2))
        J = np.empty((*ω.shape, 3, 2))
        for wheel, sign in enumerate((-1, 1)):
            J[..., 0, wheel] = c / 2 - d * s * (sign * per_metre)
            J[..., 1, wheel] = s / 2 + d * c * (sign * per_metre)
            J[..., 2, wheel] = sign * per_metre
        return J

    def M(self, u: Array) -> Array:
        """diag((ratio Δd_L)² + floor², (ratio Δd_R)² + floor²) : (…, 2, 2)"""
        M = np.zeros((*u.shape[:-1], 2, 2))
        for wheel in (0, 1):
            M[..., wheel, wheel] = (self.wheel_ratio * u[..., wheel]) ** 2 + self.wheel_floor**2
        return M

    def Q(self, u: Array) -> Array | float:
        """The process noise : (3, 3)          eq. 8"""
        return self.process

    def _way(self, u: Array) -> Array:
        """d = (Δd_R + Δd_L)/2"""
        return (u[..., 1] + u[..., 0]) / 2

    def _ratio(self, u: Array) -> Array:
        """(Δd_R − Δd_L)/W"""
        return (u[..., 1] - u[..., 0]) / self.width

    def _turn(self, u: Array) -> Array:
        """What the heading gains.          eq. 33"""
        return np.arctan(self._ratio(u))


@dataclass(frozen=True, slots=True, eq=False)
class SkidSteer(Motion):
    """x = (x, y, θ) in m, m, rad; u = (u_L, u_R, dt) in m/s, m/s, s: speeds of the two sides.

    How the sides' speeds move the body depends on the terrain: the coefficients are measured.
    """

    # a_ij: rows for u_x, u_y (m/s per m/s), ω_R (rad/s per m/s); columns R, L
    matrix: tuple[tuple[float, float], ...]
    sigma: float  # m/s, of each side's speed
    process: Array | float = 0.0  # (3, 3)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """u_L, u_R, dt"""
        return Quantity("left", "m/s"), Quantity("right", "m/s"), Quantity("dt", "s")

    def f(self, x: Array, u: Array) -> Array:
        """V = (u_x, u_y, ω_R) = A (u_R, u_L), held for dt at the mid heading m          eqs 29, 30

        (x + (u_x cos m − u_y sin m) dt,  y + (u_x sin m + u_y cos m) dt,  θ + ω_R dt)
        m = θ + ω_R dt/2
        """
        east, north, ω = self._velocity(x, u)
        dt = u[..., 2]
        return np.stack(
            [x[..., 0] + east * dt, x[..., 1] + north * dt, wrap(x[..., 2] + ω * dt)], axis=-1
        )

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 3, 3)          the heading turns the velocity"""
        east, north, _ = self._velocity(x, u)
        J = np.zeros((*east.shape, 3, 3))
        J[..., 0, 0] = J[..., 1, 1] = J[..., 2, 2] = 1
        J[..., 0, 2] = -north * u[..., 2]
        J[..., 1, 2] = east * u[..., 2]
        return J

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 3, 3); a column (a_x, a_y, a_ω) of A moves the body so:

        ∂(x, y)/∂u_i = R(m) (a_x, a_y) dt + a_ω dt/2 · (−v_y, v_x) dt        ∂θ/∂u_i = a_ω dt
        """
        east, north, ω = self._velocity(x, u)
        dt = u[..., 2]
        middle = x[..., 2] + ω * dt / 2
        c, s = np.cos(middle), np.sin(middle)
        J = np.empty((*east.shape, 3, 3))
        for column, side in enumerate((1, 0)):  # u is L, R; A's columns are R, L
            a_x, a_y, a_ω = (row[side] for row in self.matrix)
            J[..., 0, column] = (c * a_x - s * a_y) * dt - north * a_ω * dt**2 / 2
            J[..., 1, column] = (s * a_x + c * a_y) * dt + east * a_ω * dt**2 / 2
            J[..., 2, column] = a_ω * dt
        J[..., 0, 2] = east - north * ω * dt / 2
        J[..., 1, 2] = north + east * ω * dt / 2
        J[..., 2, 2] = ω
        return J

    def M(self, u: Array) -> Array:
        """diag(σ², σ², 0) : (…, 3, 3)"""
        return alike(independent(self.sigma, self.sigma, 0.0), u.shape[:-1])

    def Q(self, u: Array) -> Array | float:
        """The process noise : (3, 3)          eq. 8"""
        return self.process

    def _velocity(self, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """v_x and v_y in the world's frame at the mid heading, and ω_R.          eq. 30"""
        left, right, dt = u[..., 0], u[..., 1], u[..., 2]
        u_x, u_y, ω = (a_r * right + a_l * left for a_r, a_l in self.matrix)
        middle = x[..., 2] + ω * dt / 2
        c, s = np.cos(middle), np.sin(middle)
        return u_x * c - u_y * s, u_x * s + u_y * c, np.broadcast_to(ω, middle.shape)
