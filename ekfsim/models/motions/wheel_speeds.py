"""The speeds of two wheels, and a state that holds the robot's speed (document 003)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.noise import per_second
from ekfsim.models.protocols import Motion, Quantity

INPUTS = Quantity("left", "m/s"), Quantity("right", "m/s"), Quantity("dt", "s")


@dataclass(frozen=True, slots=True)
class WheelSpeeds(Motion):
    """x = (V, φ, x, y) in m/s, rad, m, m; u = (v_L, v_R, dt) in m/s, m/s, s."""

    half_track: float  # m, R: from the middle to each wheel
    speed_density: float  # m/s per √Hz, white noise of the speed
    turn_density: float  # rad/s per √Hz, white noise of the turn rate

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """v_L, v_R, dt"""
        return INPUTS

    def f(self, x: Array, u: Array) -> Array:
        """The document's three integrals as sums : (…, 4)          eq. 3; section 2

            V = (v_L + v_R)/2         φ = φ + (v_R − v_L)/(2R) dt
            x = x + V cos φ dt        y = y + V sin φ dt

        At the new V and φ.
        """
        V, rate, dt = self._motion(u)
        φ = x[..., 1] + rate * dt
        after = V, wrap(φ), x[..., 2] + V * np.cos(φ) * dt, x[..., 3] + V * np.sin(φ) * dt
        return np.stack(np.broadcast_arrays(*after), axis=-1)

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, 4, 4)          eq. 4

        The old V counts for nothing: the wheels tell the new one.
        """
        V, rate, dt = self._motion(u)
        φ = x[..., 1] + rate * dt
        J = np.zeros((*φ.shape, 4, 4))
        J[..., 1, 1] = J[..., 2, 2] = J[..., 3, 3] = 1
        J[..., 2, 1] = -V * np.sin(φ) * dt
        J[..., 3, 1] = V * np.cos(φ) * dt
        return J

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 4, 3)          ∂V/∂v_L = ∂V/∂v_R = 1/2,  ∂φ/∂v_R = −∂φ/∂v_L = dt/(2R)"""
        V, rate, dt = self._motion(u)
        φ = x[..., 1] + rate * dt
        c, s = np.cos(φ), np.sin(φ)
        J = np.zeros((*φ.shape, 4, 3))
        for wheel, sign in enumerate((-1, 1)):
            turned = sign * dt / (2 * self.half_track)
            J[..., 0, wheel] = 1 / 2
            J[..., 1, wheel] = turned
            J[..., 2, wheel] = (c / 2 - V * s * turned) * dt
            J[..., 3, wheel] = (s / 2 + V * c * turned) * dt
        J[..., 1, 2] = rate
        J[..., 2, 2] = V * c - V * dt * s * rate
        J[..., 3, 2] = V * s + V * dt * c * rate
        return J

    def M(self, u: Array) -> Array:
        """Covariance of (v_L, v_R, dt) : (…, 3, 3), 0 where no time has passed

        White noise over dt has the variances q_V = density_V²/dt of V, q_φ = density_φ²/dt of φ̇.
        The wheels are v_L = V − R φ̇ and v_R = V + R φ̇, so each has q_V + R² q_φ, and both
        together q_V − R² q_φ.
        """
        rate = per_second(u[..., 2])
        q_V, q_φ = self.speed_density**2 * rate, (self.half_track * self.turn_density) ** 2 * rate
        M = np.zeros((*rate.shape, 3, 3))
        M[..., 0, 0] = M[..., 1, 1] = q_V + q_φ
        M[..., 0, 1] = M[..., 1, 0] = q_V - q_φ
        return M

    def Q(self, u: Array) -> float:
        """The document finds its Q by trial and error; here all noise enters with u."""
        return 0.0

    def _motion(self, u: Array) -> tuple[Array, Array, Array]:
        """V = (v_L + v_R)/2      φ̇ = (v_R − v_L)/(2R)      dt"""
        left, right = u[..., 0], u[..., 1]
        return (left + right) / 2, (right - left) / (2 * self.half_track), u[..., 2]


@dataclass(frozen=True, slots=True)
class WheelSpeedsAsWritten(Motion):
    """A counter-example, not to be driven by: how the authors of document 003 predict.

    What is wrong with it: the yaw rate is made of the mean speed, V R, where (v_R − v_L)/(2R)
    belongs; the position moves by V per step, where V dt belongs; its F is not the derivative of
    its f, which takes V from the wheels; Q = I does not know how long a step lasts. It can only
    follow the fixes, and so its authors correct at every row of the wheels, by an interpolated fix;
    their innovation is taken at the state before the prediction, as by `Frozen`.
    """

    gauge: float = 0.27  # m, R

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """v_L, v_R, dt"""
        return INPUTS

    def f(self, x: Array, u: Array) -> Array:
        """The recipe : (…, 4), at the old φ

        V = (v_L + v_R)/2      φ = φ + V R dt      x = x + V cos φ      y = y + V sin φ
        """
        V, φ = (u[..., 0] + u[..., 1]) / 2, x[..., 1]
        after = (
            V,
            wrap(φ + V * self.gauge * u[..., 2]),
            x[..., 2] + V * np.cos(φ),
            x[..., 3] + V * np.sin(φ),
        )
        return np.stack(np.broadcast_arrays(*after), axis=-1)

    def F(self, x: Array, u: Array) -> Array:
        """Not ∂f/∂x, but what the recipe takes for it : (…, 4, 4)          eq. 4

        [[1/2, 0, 0, 0], [0, 1, 0, 0], [cos φ, −V sin φ, 1, 0], [sin φ, V cos φ, 0, 1]]
        """
        V, φ = (u[..., 0] + u[..., 1]) / 2, x[..., 1]
        J = np.zeros((*np.broadcast_shapes(V.shape, φ.shape), 4, 4))
        J[..., 0, 0] = 1 / 2
        J[..., 1, 1] = J[..., 2, 2] = J[..., 3, 3] = 1
        J[..., 2, 0], J[..., 2, 1] = np.cos(φ), -V * np.sin(φ)
        J[..., 3, 0], J[..., 3, 1] = np.sin(φ), V * np.cos(φ)
        return J

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, 4, 3)"""
        V, φ = (u[..., 0] + u[..., 1]) / 2, x[..., 1]
        J = np.zeros((*np.broadcast_shapes(V.shape, φ.shape), 4, 3))
        for wheel in (0, 1):
            J[..., 0, wheel] = 1 / 2
            J[..., 1, wheel] = self.gauge * u[..., 2] / 2
            J[..., 2, wheel] = np.cos(φ) / 2
            J[..., 3, wheel] = np.sin(φ) / 2
        J[..., 1, 2] = V * self.gauge
        return J

    def M(self, u: Array) -> Array:
        """The recipe has no noise of the wheels : (…, 3, 3)"""
        return np.zeros((*u.shape[:-1], 3, 3))

    def Q(self, u: Array) -> Array:
        """I : (4, 4)"""
        return np.eye(4)
