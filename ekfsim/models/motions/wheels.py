"""Two wheels whose ways are measured, without and with a gyro (document 000, section 3.1)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.motions.midpoint import arrival, by_state
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Motion, Quantity
from ekfsim.twins import twinned


def _B(middle: Array, ΔD: Array, b: float) -> Array:
    """∂f/∂(ΔD_L, ΔD_R) at the mid heading, b m between the wheels : (…, 3, 2)          eq. 22"""
    B = np.empty((*middle.shape, 3, 2))
    half_c, half_s = np.cos(middle) / 2, np.sin(middle) / 2
    lever = ΔD / b
    B[..., 0, 0] = half_c + lever * half_s
    B[..., 0, 1] = half_c - lever * half_s
    B[..., 1, 0] = half_s - lever * half_c
    B[..., 1, 1] = half_s + lever * half_c
    B[..., 2, 0] = -1 / b
    B[..., 2, 1] = 1 / b
    return B


@dataclass(frozen=True, slots=True, eq=False)
class TwoWheels(Motion):
    """x = (x, y, Φ) in m, m, rad; u = (ΔD_L, ΔD_R) in m, the ways of the two wheels."""

    width: float  # m, b: between the wheels
    wheel_sigma: float  # m, σ_γ of each wheel's way
    process: Array | float = 0.0  # (3, 3)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """ΔD_L, ΔD_R"""
        return Quantity("left", "m"), Quantity("right", "m")

    def f(self, x: Array, u: Array) -> Array:
        """(x + ΔD cos(Φ + ΔΦ/2),  y + ΔD sin(Φ + ΔΦ/2),  Φ + ΔΦ)          eqs 16 to 18"""
        return arrival(x, *self._way(u))

    def F(self, x: Array, u: Array) -> Array:
        """A = ∂f/∂x : (…, 3, 3)          eq. 21"""
        return by_state(x, *self._way(u))

    def G(self, x: Array, u: Array) -> Array:
        """B = ∂f/∂u : (…, 3, 2)          eq. 22"""
        ΔD, ΔΦ = self._way(u)
        return _B(x[..., 2] + ΔΦ / 2, ΔD, self.width)

    def M(self, u: Array) -> Array:
        """Γ = σ_γ² I : (…, 2, 2)          eq. 26"""
        return alike(independent(self.wheel_sigma, self.wheel_sigma), u.shape[:-1])

    def Q(self, u: Array) -> Array | float:
        """The process noise : (3, 3)          eq. 26"""
        return self.process

    def _way(self, u: Array) -> tuple[Array, Array]:
        """ΔD = (ΔD_R + ΔD_L)/2      ΔΦ = (ΔD_R − ΔD_L)/b          eqs 19, 20"""
        left, right = u[..., 0], u[..., 1]
        return (right + left) / 2, (right - left) / self.width


@dataclass(frozen=True, slots=True, eq=False)
class GyroWheels(Motion):
    """x = (x, y, Φ) in m, m, rad; u = (ΔD_L, ΔD_R, ω, dt) in m, m, rad/s, s.

    The gyro turns, the wheels drive. The heading's noise is the wheels' all the same (eq. 22), as
    the text and its listing mean it: G's first two columns are B, not the derivative of an f that
    takes no turn from the wheels.
    """

    width: float  # m, b: between the wheels
    wheel_sigma: float  # m, σ_γ of each wheel's way
    process: Array | float  # (3, 3), Q of eq. 29
    gyro_sigma: float = 0.0  # rad/s; the document leaves the gyro's noise to Q

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """ΔD_L, ΔD_R, ω, dt"""
        return (
            Quantity("left", "m"),
            Quantity("right", "m"),
            Quantity("turn rate", "rad/s"),
            Quantity("dt", "s"),
        )

    @twinned
    def f(self, x: Array, u: Array) -> Array:
        """(x + ΔD cos(Φ + ω dt/2),  y + ΔD sin(Φ + ω dt/2),  Φ + ω dt) : (…, 3)

        Eqs 16 to 19, and the listing, which keeps Φ in (−2π, 2π); here it is in (−π, π].
        """
        return arrival(x, *self._way(u))

    def F(self, x: Array, u: Array) -> Array:
        """A = ∂f/∂x : (…, 3, 3)          eq. 21 at the gyro's mid heading"""
        return by_state(x, *self._way(u))

    def G(self, x: Array, u: Array) -> Array:
        """[B | ∂f/∂ω | ∂f/∂dt] : (…, 3, 4)          B: eq. 22 at the gyro's mid heading"""
        (ΔD, ΔΦ), ω, dt = self._way(u), u[..., 2], u[..., 3]
        middle = x[..., 2] + ΔΦ / 2
        east, north = ΔD * np.cos(middle), ΔD * np.sin(middle)
        G = np.empty((*middle.shape, 3, 4))
        G[..., :2] = _B(middle, ΔD, self.width)
        G[..., 0, 2] = -north * dt / 2
        G[..., 1, 2] = east * dt / 2
        G[..., 2, 2] = dt
        G[..., 0, 3] = -north * ω / 2
        G[..., 1, 3] = east * ω / 2
        G[..., 2, 3] = ω
        return G

    def M(self, u: Array) -> Array:
        """diag(σ_γ², σ_γ², σ_ω², 0) : (…, 4, 4)          eq. 26; a clock does not err"""
        return alike(
            independent(self.wheel_sigma, self.wheel_sigma, self.gyro_sigma, 0.0), u.shape[:-1]
        )

    def Q(self, u: Array) -> Array | float:
        """The process noise : (3, 3)          eq. 29"""
        return self.process

    def _way(self, u: Array) -> tuple[Array, Array]:
        """ΔD = (ΔD_R + ΔD_L)/2      ΔΦ = ω dt          eq. 19, listing"""
        return (u[..., 1] + u[..., 0]) / 2, u[..., 2] * u[..., 3]


@dataclass(frozen=True, slots=True, eq=False)
class WheelsBesideGyro(GyroWheels):
    """The same input where the wheels tell the turn, and no one asks the gyro: eqs 16 to 22."""

    def f(self, x: Array, u: Array) -> Array:
        """(x + ΔD cos(Φ + ΔΦ/2),  y + ΔD sin(Φ + ΔΦ/2),  Φ + ΔΦ)          eqs 16 to 18"""
        return arrival(x, *self._way(u))

    def G(self, x: Array, u: Array) -> Array:
        """[B | 0 | 0] : (…, 3, 4)          B: eq. 22"""
        ΔD, ΔΦ = self._way(u)
        middle = x[..., 2] + ΔΦ / 2
        G = np.zeros((*middle.shape, 3, 4))
        G[..., :2] = _B(middle, ΔD, self.width)
        return G

    def _way(self, u: Array) -> tuple[Array, Array]:
        """ΔD = (ΔD_R + ΔD_L)/2      ΔΦ = (ΔD_R − ΔD_L)/b          eqs 19, 20"""
        left, right = u[..., 0], u[..., 1]
        return (right + left) / 2, (right - left) / self.width
