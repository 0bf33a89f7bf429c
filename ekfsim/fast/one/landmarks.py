"""Sensors of one robot that see landmarks, in plain floats."""

import math

import numpy as np

from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.geometry import Array
from ekfsim.models.noise import independent
from ekfsim.models.sensors.landmarks import (
    AT_IT,
    BearingOnly,
    MarkerAngles,
    RangeBearing,
    RangeOnly,
)

Linearized = tuple[Array, Array, Array]  # h, H, R


def marker_angles(sensor: MarkerAngles, x: Array) -> Linearized | None:
    """Twin of h, H and R of `MarkerAngles`."""
    if x.ndim != 1:
        return None
    (ex, ey, d, α), μ = _polar(sensor, x), sensor.height
    R = independent(sensor.azimuth_sigma, sensor.elevation_sigma)
    if d == 0.0:
        return np.array([α, -math.atan2(μ, 0.0)]), np.zeros((2, len(x))), R
    slant = math.hypot(μ, d)
    η_d = sensor.elevation_sign * μ / slant / slant
    rows = [ey / d, -ex / d, -1.0], [-η_d * ex, -η_d * ey, 0.0]
    return np.array([α, -math.atan2(μ, d)]), _placed(sensor, x, *rows), R


def range_bearing(sensor: RangeBearing, x: Array) -> Linearized | None:
    """Twin of h, H and R of `RangeBearing`."""
    if x.ndim != 1:
        return None
    ex, ey, r, β = _polar(sensor, x)
    H = _placed(sensor, x, [-ex, -ey, 0.0], _turning(ex, ey, r))
    return np.array([r, β]), H, independent(sensor.range_sigma, sensor.bearing_sigma)


def range_only(sensor: RangeOnly, x: Array) -> Linearized | None:
    """Twin of h, H and R of `RangeOnly`."""
    if x.ndim != 1:
        return None
    ex, ey, r, _ = _polar(sensor, x)
    return np.array([r]), _placed(sensor, x, [-ex, -ey, 0.0]), independent(sensor.sigma)


def bearing_only(sensor: BearingOnly, x: Array) -> Linearized | None:
    """Twin of h, H and R of `BearingOnly`."""
    if x.ndim != 1:
        return None
    ex, ey, r, β = _polar(sensor, x)
    return np.array([β]), _placed(sensor, x, _turning(ex, ey, r)), independent(sensor.sigma)


Landmark = MarkerAngles | RangeBearing | RangeOnly | BearingOnly


def _polar(sensor: Landmark, x: Array) -> tuple[float, float, float, float]:
    """Unit vector to a landmark, distance and bearing. At the landmark no vector, no distance."""
    state = x.tolist()
    px, py, θ = (state[place] for place in sensor.layout.places)
    dx, dy = sensor.x - px, sensor.y - py
    d, bearing = math.hypot(dx, dy), wrap_one(math.atan2(dy, dx) - θ)
    return (dx / d, dy / d, d, bearing) if d > AT_IT else (0.0, 0.0, 0.0, bearing)


def _turning(ex: float, ey: float, r: float) -> list[float]:
    """The derivatives of a bearing."""
    return [ey / r, -ex / r, -1.0] if r else [0.0, 0.0, 0.0]


def _placed(sensor: Landmark, x: Array, *rows: list[float]) -> Array:
    """Derivatives by x, y, θ as H : (k, n)"""
    if sensor.layout.is_pose:
        return np.array(rows)
    H = np.zeros((len(rows), len(x)))
    H[:, sensor.layout.places] = rows
    return H


def marker_residual(sensor: MarkerAngles, z: Array, h: Array) -> Array | None:
    """Twin of `MarkerAngles.residual`."""
    if not z.ndim == h.ndim == 1:
        return None
    (α, η), (α_h, η_h) = z.tolist(), h.tolist()
    return np.array([wrap_one(α - α_h), wrap_one(η - η_h)])
