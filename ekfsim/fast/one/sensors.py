"""The laser of one robot, in plain floats: its beam is cast once for h, H and R."""

import math

import numpy as np

from ekfsim.fast.one.normal import normal_one
from ekfsim.geometry import Array
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
    nx, ny = normal_one(sensor.walls, wall, px + r * dx, py + r * dy)
    n_d = nx * dx + ny * dy
    if not abs(n_d) > ALONG:
        return np.array([math.nan]), np.zeros((1, 3)), np.array([[math.nan]])
    H = np.array([[-nx / n_d, -ny / n_d, -r * (ny * dx - nx * dy) / n_d]])
    return np.array([r]), H, np.array([[(sensor.range_ratio * r) ** 2]])
