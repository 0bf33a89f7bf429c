"""Landmarks at known places: the angles, the bearing and the range under which a robot sees them.

Whatever else the state holds, these depend on its pose alone; `layout` tells where that stands.
"""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.noise import alike, independent
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.twins import twinned

AT_IT = 1e-9  # m; nearer than this there is no direction to a landmark, and no derivative


class _Landmark(Sensor):
    """What the sensors of this file share."""

    __slots__ = ()
    x: float  # m
    y: float
    layout: Layout

    def _offset(self, x: Array) -> tuple[Array, Array]:
        """How far the landmark is to the east and to the north of the robot : (…) m each"""
        px, py, _ = self.layout.places
        return self.x - x[..., px], self.y - x[..., py]

    def _bearing(self, x: Array) -> Array:
        """atan2(p_B − p) − θ : (…)"""
        dx, dy = self._offset(x)
        return wrap(np.arctan2(dy, dx) - x[..., self.layout.heading])

    def _away(self, x: Array) -> tuple[Array, Array, Array]:
        """Unit vector e to the landmark, and the distance; both 0 at the landmark."""
        dx, dy = self._offset(x)
        d = np.hypot(dx, dy)
        d = np.where(d > AT_IT, d, 0.0)
        return _per(dx, d), _per(dy, d), d

    def _placed(self, x: Array, *rows: tuple[Array | float, ...]) -> Array:
        """Derivatives by x, y, θ, a row for each entry of z, as H : (…, k, n)"""
        H = np.zeros((*x.shape[:-1], len(rows), x.shape[-1]))
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
        _, _, d = self._away(x)
        return np.stack([self._bearing(x), -np.arctan2(self.height, d)], axis=-1)

    def H(self, x: Array) -> Array:
        """∂h/∂x : (…, 2, n), 0 at the marker          eq. 25

            ∂α/∂x = (y_B − y)/d²                    ∂α/∂y = −(x_B − x)/d²
            ∂α/∂Φ = −1
            ∂η/∂x = −μ(x_B − x)/(d(μ² + d²))        ∂η/∂y = −μ(y_B − y)/(d(μ² + d²))
            ∂η/∂Φ = 0

        Eq. 25 prints ∂η/∂x and ∂η/∂y without the minus.
        """
        ex, ey, d = self._away(x)
        slant = np.where(d > 0, np.hypot(self.height, d), 1.0)
        η_d = self.elevation_sign * self.height / slant / slant  # μ/(μ² + d²)
        turned = np.where(d > 0, -1.0, 0.0)
        return self._placed(x, (_per(ey, d), -_per(ex, d), turned), (-η_d * ex, -η_d * ey, 0.0))

    def R(self, x: Array) -> Array:
        """diag(σ_α², σ_η²) : (…, 2, 2)          eq. 30"""
        return alike(independent(self.azimuth_sigma, self.elevation_sigma), x.shape[:-1])

    @twinned
    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, both angles wrapped : (…, 2)"""
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

    def h(self, x: Array) -> Array:
        """r = |p_B − p|      β = atan2(p_B − p) − θ : (…, 2)"""
        _, _, r = self._away(x)
        return np.stack([r, self._bearing(x)], axis=-1)

    def H(self, x: Array) -> Array:
        """∂h/∂x : (…, 2, n); e is the unit vector to the landmark

        ∂r/∂p = −eᵀ                  ∂r/∂θ = 0
        ∂β/∂p = (e_y, −e_x)/r        ∂β/∂θ = −1
        """
        ex, ey, r = self._away(x)
        turned = np.where(r > 0, -1.0, 0.0)
        return self._placed(x, (-ex, -ey, 0.0), (_per(ey, r), -_per(ex, r), turned))

    def R(self, x: Array) -> Array:
        """diag(σ_r², σ_β²) : (…, 2, 2)"""
        return alike(independent(self.range_sigma, self.bearing_sigma), x.shape[:-1])

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

    def h(self, x: Array) -> Array:
        """r = |p_B − p| : (…, 1)"""
        _, _, r = self._away(x)
        return r[..., None]

    def H(self, x: Array) -> Array:
        """∂r/∂p = −eᵀ : (…, 1, n), e the unit vector to the landmark"""
        ex, ey, _ = self._away(x)
        return self._placed(x, (-ex, -ey, 0.0))

    def R(self, x: Array) -> Array:
        """σ² : (…, 1, 1)"""
        return alike(independent(self.sigma), x.shape[:-1])


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

    def h(self, x: Array) -> Array:
        """β = atan2(p_B − p) − θ : (…, 1)"""
        return self._bearing(x)[..., None]

    def H(self, x: Array) -> Array:
        """∂β/∂p = (e_y, −e_x)/r, ∂β/∂θ = −1 : (…, 1, n), 0 at the landmark"""
        ex, ey, r = self._away(x)
        turned = np.where(r > 0, -1.0, 0.0)
        return self._placed(x, (_per(ey, r), -_per(ex, r), turned))

    def R(self, x: Array) -> Array:
        """σ² : (…, 1, 1)"""
        return alike(independent(self.sigma), x.shape[:-1])

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h, wrapped : (…, 1)"""
        return wrap(z - h)
