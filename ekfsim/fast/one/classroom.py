"""The classroom's robot by itself, in plain floats."""

import math

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.ground import CLEARANCE
from ekfsim.raycast.searches.single_beam import first
from ekfsim.raycast.walls import Walls


def until_wall(
    walls: Walls, pose: Array, way: Array | float
) -> tuple[Array | float, Integers] | None:
    """Twin of `until_wall`, of one robot."""
    if pose.ndim != 1 or np.ndim(way):
        return None
    (x, y, θ), way = pose.tolist(), float(way)
    r, wall = first(walls, x, y, θ + math.pi if way < 0 else θ)
    free = max(r - CLEARANCE, 0.0)
    bumped = wall >= 0 and abs(way) > free
    return math.copysign(free, way) if bumped else way, np.array(wall if bumped else -1)


def paired(d: Array | float, a: Array | float) -> Array | None:
    """(d, a) as one motion input."""
    if isinstance(d, float) and isinstance(a, float):  # of NumPy's, too
        return np.array([d, a])
    return None if np.ndim(d) or np.ndim(a) else np.array([d, a])
