"""Walls that look alike: a beam that meets one of a row is as well explained by the next."""

from collections.abc import Sequence

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.records import Entry, Reading, Step
from ekfsim.why.changes.beams import met

ROW = 4  # so many in a row look alike
SAME = 1e-6  # m


def alike(wrong: Sequence[Step]) -> bool:
    """Whether most beams that were predicted on a wrong wall had to do with one of a row."""
    told = [_of_a_row(step) for step in wrong]
    return 2 * sum(told) > len(told)


def _of_a_row(step: Step) -> bool:
    match step.entry:
        case Entry(given=Reading(Laser() as beam, _), truth=np.ndarray() as truth):
            both = met(beam, step.prior.mean).wall, met(beam, truth).wall
            return any(in_a_row(beam.walls, int(wall)) for wall in both if wall >= 0)
    return False


def in_a_row(walls: Walls, wall: int) -> bool:
    """Whether a wall is one of four or more of the same size and direction, evenly spaced on a
    line.
    """
    W = len(walls.segments)
    if wall < W:
        ends = walls.segments
        ways = ends[:, 1] - ends[:, 0]
        same = np.abs(ways - ways[wall]).max(axis=-1) < SAME
        places, here = ends[same, 0], ends[wall, 0]
    else:
        same = np.abs(walls.circles[:, 2] - walls.circles[wall - W, 2]) < SAME
        places, here = walls.circles[same, :2], walls.circles[wall - W, :2]
    return any(_row(places, here, other - here) >= ROW for other in places)


def _row(places: Array, here: Array, step: Array) -> int:
    """How many places lie at even steps to either side of one of them, itself counted."""
    if np.abs(step).max() < SAME:
        return 0
    return 1 + sum(_on(places, here, sign * step) for sign in (-1, 1))


def _on(places: Array, here: Array, step: Array) -> int:
    """How many follow at even steps on one side."""
    n = 0
    while (np.abs(places - (here + (n + 1) * step)).max(axis=-1) < SAME).any():
        n += 1
    return n
