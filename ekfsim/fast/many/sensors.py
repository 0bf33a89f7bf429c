"""Beams of many runs, of sigma points or of particles: cast once for h, H and R."""

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.soa import from_soa, soa_zeros, to_soa
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.laser import ALONG, Laser
from ekfsim.models.sensors.laser_by_reading import LaserByReading
from ekfsim.models.sensors.mounted import Mounted
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.raycast.walls import Hit, Walls

Linearized = tuple[Array, Array, Array]  # h, H, R


def laser(sensor: Laser, x: Array) -> Linearized:
    """Twin of h, H and R of `Laser`."""
    direction = x[..., 2] + sensor.bearing
    hit = sensor.walls.cast(x[..., :2], direction)
    c, s = np.cos(direction), np.sin(direction)
    nx, ny = to_soa(_normal(sensor.walls, hit, x, c, s), 1)
    n_d = nx * c + ny * s
    met = np.abs(n_d) > ALONG
    r = hit.range
    if met.all():
        per = -1.0 / n_d
    else:
        r, per = (
            np.where(met, r, np.nan),
            np.divide(-1.0, n_d, out=np.zeros_like(n_d), where=met),
        )
    H, R = soa_zeros(r.shape, 1, 3), soa_zeros(r.shape, 1, 1)
    H[..., 0, 0], H[..., 0, 1] = nx * per, ny * per
    H[..., 0, 2] = np.where(met, r, 0.0) * (ny * c - nx * s) * per
    R[..., 0, 0] = np.square(sensor.range_ratio * r)
    return r[..., None], H, R


def laser_by_reading(sensor: LaserByReading, x: Array) -> Linearized:
    """Twin of h, H and R of `LaserByReading`."""
    h, H, R = Laser(sensor.walls, sensor.bearing, sensor.range_ratio).linearize(x)
    z = sensor.z if h.ndim == sensor.z.ndim else sensor.z[..., None, :]
    known = ~(np.isnan(h) | np.isnan(z))
    return h, H, np.where(known[..., None], np.square(sensor.range_ratio * z)[..., None], R)


def ultrasonic(sensor: UltrasonicBeam, x: Array) -> Linearized:
    """Twin of h, H and R of `UltrasonicBeam`."""
    r, H, _ = Laser(sensor.walls, sensor.bearing, 0.0).linearize(x)
    heard = (r >= sensor.nearest) & (r <= sensor.farthest)
    r = np.where(heard, r, np.nan)
    R = (sensor.sigma + sensor.sigma_per_metre * r[..., None]) ** 2
    return r, np.where(heard[..., None], H, 0.0), R


def infrared(sensor: InfraredBeam, x: Array) -> Linearized:
    """Twin of h, H and R of `InfraredBeam`."""
    r, H_r, _ = Laser(sensor.walls, sensor.bearing, 0.0).linearize(x)
    lit = (r >= sensor.nearest) & (r <= sensor.farthest)
    r = np.where(lit, r, 1.0)
    intensity = sensor.reflectance * (sensor.offset - sensor.gain * np.log(r))
    H = np.where(lit[..., None], -sensor.reflectance * sensor.gain / r[..., None] * H_r, 0.0)
    R = np.where(lit, sensor.sigma**2, np.nan)[..., None]
    return np.where(lit, intensity, np.nan), H, R


def frozen(sensor: Frozen, x: Array) -> Linearized | None:
    """Twin of h, H and R of `Frozen`: by the twin of the sensor that it holds."""
    return sensor.sensor.linearize(sensor.at) if sensor.at.shape == x.shape else None


def mounted(sensor: Mounted, x: Array) -> Linearized:
    """Twin of h, H and R of `Mounted`: by the twin of the sensor that it carries."""
    h, H, R = sensor.sensor.linearize(sensor._pose(x))
    return h, sensor._placed(H, x), R


def _normal(walls: Walls, hit: Hit, x: Array, c: Array, s: Array) -> Array:
    """Unit normals : (…, 2), zero where there is no wall."""
    wall = hit.wall
    if walls.round:
        place = np.stack([x[..., 0] + hit.range * c, x[..., 1] + hit.range * s], axis=-1)
        return walls.normal_at(wall, place)
    if not len(walls.normals):
        return np.zeros((*wall.shape, 2))
    normals = from_soa(to_soa(walls.normals, 1)[:, wall], 1)
    normals[wall < 0] = 0.0
    return normals
