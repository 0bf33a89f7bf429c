"""Landmarks seen by many runs, by sigma points or by particles: the way to them is worked out once
for h, H and R.
"""

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.soa import soa_zeros
from ekfsim.models.noise import alike, independent
from ekfsim.models.sensors.landmarks import (
    AT_IT,
    BearingOnly,
    MarkerAngles,
    RangeBearing,
    RangeOnly,
)
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset

Linearized = tuple[Array, Array, Array]  # h, H, R
Landmark = MarkerAngles | RangeBearing | RangeOnly | BearingOnly
Row = tuple[Array | float, ...]  # derivatives by x, y, θ


def marker_angles(sensor: MarkerAngles, x: Array) -> Linearized:
    """Twin of h, H and R of `MarkerAngles`."""
    dx, dy, ex, ey, d = _away(sensor, x)
    slant = np.where(d > 0, np.hypot(sensor.height, d), 1.0)
    η_d = sensor.elevation_sign * sensor.height / slant / slant
    h = soa_zeros(x.shape[:-1], 2)
    h[..., 0], h[..., 1] = _bearing(sensor, x, dx, dy), -np.arctan2(sensor.height, d)
    H = _placed(sensor, x, _turning(ex, ey, d), (-η_d * ex, -η_d * ey))
    return h, H, alike(independent(sensor.azimuth_sigma, sensor.elevation_sigma), x.shape[:-1])


def range_bearing(sensor: RangeBearing, x: Array) -> Linearized:
    """Twin of h, H and R of `RangeBearing`."""
    dx, dy, ex, ey, r = _away(sensor, x)
    h = soa_zeros(x.shape[:-1], 2)
    h[..., 0], h[..., 1] = r, _bearing(sensor, x, dx, dy)
    H = _placed(sensor, x, (-ex, -ey), _turning(ex, ey, r))
    return h, H, alike(independent(sensor.range_sigma, sensor.bearing_sigma), x.shape[:-1])


def range_only(sensor: RangeOnly, x: Array) -> Linearized:
    """Twin of h, H and R of `RangeOnly`."""
    _, _, ex, ey, r = _away(sensor, x)
    H = _placed(sensor, x, (-ex, -ey))
    return r[..., None], H, alike(independent(sensor.sigma), x.shape[:-1])


def bearing_only(sensor: BearingOnly, x: Array) -> Linearized:
    """Twin of h, H and R of `BearingOnly`."""
    dx, dy, ex, ey, r = _away(sensor, x)
    h = _bearing(sensor, x, dx, dy)[..., None]
    H = _placed(sensor, x, _turning(ex, ey, r))
    return h, H, alike(independent(sensor.sigma), x.shape[:-1])


def lidar_offset(sensor: LidarOffset, x: Array) -> Linearized:
    """Twin of h, H and R of `LidarOffset`."""
    (i, j), k = sensor.layout.position, sensor.layout.heading
    east, north, θ = sensor.x - x[..., i], sensor.y - x[..., j], x[..., k]
    s, c = np.sin(θ), np.cos(θ)
    h, H = soa_zeros(θ.shape, 2), soa_zeros(θ.shape, 2, x.shape[-1])
    h[..., 0], h[..., 1] = right, ahead = east * s - north * c, east * c + north * s
    H[..., 0, i], H[..., 0, j], H[..., 0, k] = -s, c, ahead
    H[..., 1, i], H[..., 1, j], H[..., 1, k] = -c, -s, -right
    return h, H, alike(independent(sensor.sigma, sensor.sigma), θ.shape)


def landmark_offset(sensor: LandmarkOffset, x: Array) -> Linearized | None:
    """Twin of h, H and R of `LandmarkOffset`, where no noise of the yaw is told."""
    if sensor.yaw_sigma != 0:
        return None
    (i, j), axes = sensor.layout.position, x.shape[:-1]
    h, H = soa_zeros(axes, 2), soa_zeros(axes, 2, x.shape[-1])
    h[..., 0], h[..., 1] = sensor.x - x[..., i], sensor.y - x[..., j]
    H[..., 0, i] = H[..., 1, j] = -1.0
    return h, H, alike(independent(sensor.sigma_x, sensor.sigma_y), axes)


def _away(sensor: Landmark, x: Array) -> tuple[Array, ...]:
    """The way to the landmark, its unit vector and the distance. At it no vector, no distance."""
    px, py, _ = sensor.layout.places
    dx, dy = sensor.x - x[..., px], sensor.y - x[..., py]
    d = np.hypot(dx, dy)
    away = d > AT_IT
    if away.all():
        return dx, dy, dx / d, dy / d, d
    d = np.where(away, d, 0.0)
    return dx, dy, _per(dx, d), _per(dy, d), d


def _per(value: Array, d: Array) -> Array:
    """value/d, 0 at the landmark, where d is 0."""
    return np.divide(value, d, out=np.zeros(d.shape), where=d > 0)


def _bearing(sensor: Landmark, x: Array, dx: Array, dy: Array) -> Array:
    """The direction in which the robot sees it."""
    return wrap(np.arctan2(dy, dx) - x[..., sensor.layout.heading])


def _turning(ex: Array, ey: Array, r: Array) -> Row:
    """The derivatives of a bearing."""
    seen = r > 0
    if seen.all():
        return ey / r, -ex / r, -1.0
    return _per(ey, r), _per(-ex, r), np.where(seen, -1.0, 0.0)


def _placed(sensor: Landmark, x: Array, *rows: Row) -> Array:
    """Derivatives by x, y, θ as H : (…, k, n), 0 where a row tells of none"""
    H = soa_zeros(x.shape[:-1], len(rows), x.shape[-1])
    for i, row in enumerate(rows):
        for column, derivative in zip(sensor.layout.places, row, strict=False):
            H[..., i, column] = derivative
    return H
