"""Sensors of one robot, in plain floats; a beam is cast once for h, H and R."""

import math

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap_one
from ekfsim.models.noise import independent
from ekfsim.models.sensors.landmarks import AT_IT, MarkerAngles
from ekfsim.models.sensors.laser import ALONG, Laser
from ekfsim.raycast.searches.single_beam import first

Linearized = tuple[Array, Array, Array]  # h, H, R


def laser(sensor: Laser, x: Array) -> Linearized | None:
    """Twin of h, H and R of `Laser`."""
    if x.ndim != 1:
        return None
    px, py, θ = x.tolist()
    direction = θ + sensor.bearing
    r, wall = first(sensor.walls, px, py, direction)
    dx, dy = math.cos(direction), math.sin(direction)
    nx, ny = sensor.walls.normals[wall].tolist() if wall >= 0 else (0.0, 0.0)
    n_d = nx * dx + ny * dy
    if not abs(n_d) > ALONG:
        return np.array([math.nan]), np.zeros((1, 3)), np.array([[math.nan]])
    H = np.array([[-nx / n_d, -ny / n_d, -r * (ny * dx - nx * dy) / n_d]])
    return np.array([r]), H, np.array([[(sensor.range_ratio * r) ** 2]])


def marker_angles(sensor: MarkerAngles, x: Array) -> Linearized | None:
    """Twin of h, H and R of `MarkerAngles`."""
    if x.ndim != 1:
        return None
    state, places, μ = x.tolist(), sensor.layout.places, sensor.height
    px, py, Φ = (state[place] for place in places)
    dx, dy = sensor.x - px, sensor.y - py
    d, α = math.hypot(dx, dy), wrap_one(math.atan2(dy, dx) - Φ)
    R = independent(sensor.azimuth_sigma, sensor.elevation_sigma)
    if d <= AT_IT:
        return np.array([α, -math.atan2(μ, 0.0)]), np.zeros((2, len(state))), R
    ex, ey, slant = dx / d, dy / d, math.hypot(μ, d)
    η_d = sensor.elevation_sign * μ / slant / slant
    H = np.array([[ey / d, -ex / d, -1.0], [-η_d * ex, -η_d * ey, 0.0]])
    if not sensor.layout.is_pose:
        placed = np.zeros((2, len(state)))
        placed[:, places] = H
        H = placed
    return np.array([α, -math.atan2(μ, d)]), H, R


def marker_residual(sensor: MarkerAngles, z: Array, h: Array) -> Array | None:
    """Twin of `MarkerAngles.residual`."""
    if not z.ndim == h.ndim == 1:
        return None
    (α, η), (α_h, η_h) = z.tolist(), h.tolist()
    return np.array([wrap_one(α - α_h), wrap_one(η - η_h)])
