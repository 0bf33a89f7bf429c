"""Landmarks at known places: the angles, the bearing and the range under which a robot sees them.

Whatever else the state holds, these depend on its pose alone; `layout` tells where that stands.
"""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap, wrap_one
from ekfsim.geometry.soa import lanes
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Quantity, Sensor

AT_IT = 1e-9  # m; nearer than this there is no direction to a landmark, and no derivative


class _Landmark(Sensor):
    """What the sensors of this file share."""

    __slots__ = ()
    x: float  # m
    y: float
    layout: Layout

    def _polar(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """Unit vector to the landmark, distance and bearing. At the landmark: no vector, and no
        distance.
        """
        px, py, θ = self.layout.places
        dx, dy = self.x - x[..., px], self.y - x[..., py]
        return *self._away(x), wrap(np.arctan2(dy, dx) - x[..., θ])

    def _away(self, x: Array) -> tuple[Array, Array, Array]:
        """The same without the bearing."""
        px, py, _ = self.layout.places
        dx, dy = self.x - x[..., px], self.y - x[..., py]
        d = np.hypot(dx, dy)
        away = d > AT_IT
        if np.all(away):
            return dx / d, dy / d, d
        ex, ey = (np.divide(part, d, out=np.zeros_like(d), where=away) for part in (dx, dy))
        return ex, ey, np.where(away, d, 0.0)

    def _placed(self, x: Array, rows: list[list[Array | float]]) -> Array:
        """Derivatives by x, y, θ, a row for each entry of z, as H : (…, k, n)"""
        H = lanes(x.shape[:-1], len(rows), x.shape[-1])
        for i, row in enumerate(rows):
            for column, derivative in zip(self.layout.places, row, strict=True):
                H[..., i, column] = derivative
        return H


def _per(value: Array, d: Array) -> Array:
    """value/d, 0 at the landmark, where d is 0."""
    return np.divide(value, d, out=np.zeros_like(d), where=d > 0)


@dataclass(frozen=True, slots=True)
class MarkerAngles(_Landmark):
    """Azimuth α and elevation η of a marker on the ground (document 000)."""

    x: float  # m
    y: float
    height: float  # m, μ: of the camera above the ground
    azimuth_sigma: float  # rad
    elevation_sigma: float  # rad
    elevation_sign: float = 1.0  # −1: ∂η/∂x and ∂η/∂y as eq. 25 is printed
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """α, η"""
        return Quantity("azimuth", "rad"), Quantity("elevation", "rad")

    def h(self, x: Array) -> Array:
        """α = atan2(y_B − y, x_B − x) − Φ      η = −arctan(μ/d) : (…, 2)          eqs 23, 24

        Eq. 23 is printed with the arctangent of a quotient, which cannot tell ahead from behind.
        """
        return self.linearize(x)[0]

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 2), H (…, 2, n) and R (…, 2, 2).          eqs 23 to 25, 30

            ∂α/∂x = (y_B − y)/d²                    ∂α/∂y = −(x_B − x)/d²
            ∂α/∂Φ = −1
            ∂η/∂x = −μ(x_B − x)/(d(μ² + d²))        ∂η/∂y = −μ(y_B − y)/(d(μ² + d²))
            ∂η/∂Φ = 0

        Eq. 25 prints ∂η/∂x and ∂η/∂y without the minus. At the marker H is 0.
        """
        if x.ndim == 1:
            return self._linearize_one(x)
        ex, ey, d, α = self._polar(x)
        slant = np.where(d > 0, np.hypot(self.height, d), 1.0)
        η_d = self.elevation_sign * self.height / slant / slant  # μ/(μ² + d²)
        H = self._placed(
            x,
            [[_per(ey, d), -_per(ex, d), np.where(d > 0, -1.0, 0.0)], [-η_d * ex, -η_d * ey, 0.0]],
        )
        z = np.stack([α, -np.arctan2(self.height, d)], axis=-1)
        return z, H, alike(independent(self.azimuth_sigma, self.elevation_sigma), x.shape[:-1])

    def _linearize_one(self, x: Array) -> tuple[Array, Array, Array]:
        """The same for one robot in plain floats: several times as fast, held equal to the above by
        a test.
        """
        state, places, μ = x.tolist(), self.layout.places, self.height
        px, py, Φ = (state[place] for place in places)
        dx, dy = self.x - px, self.y - py
        d, α = math.hypot(dx, dy), wrap_one(math.atan2(dy, dx) - Φ)
        R = independent(self.azimuth_sigma, self.elevation_sigma)
        if d <= AT_IT:
            return np.array([α, -math.atan2(μ, 0.0)]), np.zeros((2, len(state))), R
        ex, ey, slant = dx / d, dy / d, math.hypot(μ, d)
        η_d = self.elevation_sign * μ / slant / slant
        H = np.array([[ey / d, -ex / d, -1.0], [-η_d * ex, -η_d * ey, 0.0]])
        if not self.layout.is_pose:
            placed = np.zeros((2, len(state)))
            placed[:, places] = H
            H = placed
        return np.array([α, -math.atan2(μ, d)]), H, R

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, both angles wrapped : (…, 2)"""
        if z.ndim == h.ndim == 1:
            (α, η), (α_h, η_h) = z.tolist(), h.tolist()
            return np.array([wrap_one(α - α_h), wrap_one(η - η_h)])
        return wrap(z - h)


@dataclass(frozen=True, slots=True)
class RangeBearing(_Landmark):
    """Range and bearing of a landmark."""

    x: float  # m
    y: float
    range_sigma: float  # m
    bearing_sigma: float  # rad
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """r, β"""
        return Quantity("range", "m"), Quantity("bearing", "rad")

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 2), H (…, 2, n) and R (…, 2, 2); e is the unit vector to the landmark.

        r = |p_B − p|                ∂r/∂p = −eᵀ                   ∂r/∂θ = 0
        β = atan2(p_B − p) − θ       ∂β/∂p = (e_y, −e_x)/r         ∂β/∂θ = −1
        """
        ex, ey, r, β = self._polar(x)
        H = self._placed(
            x, [[-ex, -ey, 0.0], [_per(ey, r), -_per(ex, r), np.where(r > 0, -1.0, 0.0)]]
        )
        R = alike(independent(self.range_sigma, self.bearing_sigma), x.shape[:-1])
        return np.stack([r, β], axis=-1), H, R

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, the bearing wrapped : (…, 2)"""
        ν = z - h
        ν[..., 1] = wrap(ν[..., 1])
        return ν


@dataclass(frozen=True, slots=True)
class RangeOnly(_Landmark):
    """Range of a landmark alone, as radios measure it."""

    x: float  # m
    y: float
    sigma: float  # m
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """r"""
        return (Quantity("range", "m"),)

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 1), H (…, 1, n) and R (…, 1, 1): r = |p_B − p|, ∂r/∂p = −eᵀ, e the unit vector to
        the landmark.
        """
        ex, ey, r = self._away(x)
        return (
            r[..., None],
            self._placed(x, [[-ex, -ey, 0.0]]),
            alike(independent(self.sigma), x.shape[:-1]),
        )


@dataclass(frozen=True, slots=True)
class BearingOnly(_Landmark):
    """Bearing of a landmark alone, as a camera measures it."""

    x: float  # m
    y: float
    sigma: float  # rad
    layout: Layout = POSE

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """β"""
        return (Quantity("bearing", "rad"),)

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 1), H (…, 1, n) and R (…, 1, 1): β = atan2(p_B − p) − θ, ∂β/∂p = (e_y, −e_x)/r,
        ∂β/∂θ = −1.
        """
        ex, ey, r, β = self._polar(x)
        H = self._placed(x, [[_per(ey, r), -_per(ex, r), np.where(r > 0, -1.0, 0.0)]])
        return β[..., None], H, alike(independent(self.sigma), x.shape[:-1])

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, wrapped : (…, 1)"""
        return wrap(z - h)
