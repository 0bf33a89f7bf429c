"""The classroom's robots side by side: only those near a wall look for one on their way."""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.soa import to_soa
from ekfsim.raycast.ground import CLEARANCE
from ekfsim.raycast.walls import Walls
from ekfsim.simulation.classroom import until_wall as text
from ekfsim.twins import as_written

FEW = 32  # walls near any of the robots that are sooner looked at one by one


def until_wall(walls: Walls, pose: Array, way: Array) -> tuple[Array, Integers] | None:
    """Twin of `until_wall`, of N runs."""
    if pose.ndim != 2 or np.ndim(way) != 1:
        return None
    cut, met, some = way.copy(), np.full(way.shape, -1), _may_bump(walls, pose, way)
    if some.size:
        cut[some], met[some] = as_written(text)(walls, pose[some], way[some])
    return cut, met


def _may_bump(walls: Walls, pose: Array, way: Array) -> Integers:
    """Which of N runs may meet a wall on their way or come near one: few in a study, where all go
    much the same way.
    """
    reach, place = np.abs(way) + 2 * CLEARANCE, to_soa(pose, 1)[:2]
    far = np.fmax.reduce(reach)  # of those that are numbers
    near = walls.near(np.fmin.reduce(place, axis=1) - far, np.fmax.reduce(place, axis=1) + far)
    if not 0 < len(near) <= FEW:
        return np.arange(len(way) if len(near) else 0)
    first, last = (corners[near, :, None] for corners in walls.boxes)
    return np.flatnonzero(
        ((first <= place + reach) & (last >= place - reach)).all(axis=1).any(axis=0)
    )
