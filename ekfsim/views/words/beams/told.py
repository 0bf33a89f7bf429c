"""What is said of a beam: the wall that it was expected to meet,
and what is doubtful about that.
"""

import math
from collections.abc import Iterator
from typing import Protocol, cast

import numpy as np

from ekfsim.diagnostics.ambiguity import GRAZING, Sighting, sighting_of
from ekfsim.filters.belief import posed
from ekfsim.geometry import Array
from ekfsim.models.sensors.mounted import bare, place_of
from ekfsim.raycast.walls import Walls
from ekfsim.records import Reading, Step
from ekfsim.views.words.numbers import number, point, turn

SLIGHT = 0.1  # of the longer part of an offset: a part that is shorter is not told
UNTURNED = math.radians(0.05)  # nor is a smaller turn
TANGENT = (
    "It comes from the tangent that the filter keeps, not from a beam: "
    "no wall of the map was looked for\n"
)
NEGATIVE = "A range cannot be negative: the robot is believed far from where that tangent holds\n"
MISSED = (
    "The beam of the estimate itself meets no wall of the filter's map; "
    "those of some particles do\n"
)


class Beam(Protocol):
    """A sensor that sends a beam against walls."""

    @property
    def walls(self) -> Walls:
        """Of the map that the filter is told."""


def doubts(step: Step, guarded: bool) -> str:
    """What is doubtful about a beam before its reading is used;
    nothing of a sensor that sends none.
    """
    sighting = sighting_of(step)
    if sighting is None:
        return ""
    told = ""
    if sighting.ambiguous and guarded:
        x, walls = origin(step), walls_of(step)
        others = [
            f"({elsewhere(x, sighting.probes[i])}) it would meet "
            f"{wall_name(step, int(sighting.probe_walls[i]))}"
            for i in others_met(walls, sighting)
        ]
        c = step.correction
        other = c is not None and (
            c.tangent or (sighting.wall < 0 and not np.isnan(c.predicted).any())
        )
        expected = "from the estimate it would meet" if other else "expected to meet"
        told += (
            f"This beam is ambiguous: {expected} {wall_name(step, int(sighting.wall))}, but from "
            f"a pose within "
            f"3 sigma {', and from another '.join(others)}\n"
        )
    if sighting.grazing:
        told += (
            f"This beam grazes its wall: the angle between beam and wall is "
            f"{turn(float(sighting.incidence))} degrees "
            f"(below {turn(GRAZING)}), and a small turn would move its end far\n"
        )
    return told


def expected_wall(step: Step) -> str:
    """Which wall the beam was expected to meet, and at which angle;
    nothing of a sensor that sends none.
    """
    sighting = sighting_of(step)
    if sighting is None or step.correction is None:
        return ""
    if step.correction.tangent:
        return TANGENT + (NEGATIVE if np.any(step.correction.predicted < 0) else "")
    if sighting.wall < 0:
        return MISSED
    incidence = number(math.degrees(float(sighting.incidence)))
    wall = wall_name(step, int(sighting.wall))
    return (
        f"It was expected to meet {wall}; the angle between beam and wall is {incidence} degrees\n"
    )


def others_met(walls: Walls, sighting: Sighting) -> Iterator[int]:
    """Which of the six poses make the beam ambiguous,
    one for each of the walls that it would meet from them.
    """
    line = np.append(walls.line, -1)  # the wall −1, none, takes the last
    met = set()
    for i in np.flatnonzero(sighting.astray).tolist():
        other = int(line[sighting.probe_walls[i]])
        if other not in met:
            met.add(other)
            yield i


def elsewhere(x: Array, pose: Array) -> str:
    """Where a pose is, seen from the pose x, both (3,): what matters of it.

    >>> elsewhere(np.array([1.0, 1.0, math.pi / 2]), np.array([0.69, 1.02, math.pi / 2 + 0.05]))
    '0.31 m to the left, turned 2.9 degrees to the left'
    """
    east, north, turned = (pose - x).tolist()
    c, s = math.cos(x[2]), math.sin(x[2])
    ahead, left = c * east + s * north, c * north - s * east
    slight = SLIGHT * max(abs(ahead), abs(left))
    told = []
    if abs(ahead) > slight:
        told.append(f"{abs(ahead):.2g} m {'ahead' if ahead > 0 else 'behind'}")
    if abs(left) > slight:
        told.append(f"{abs(left):.2g} m to the {'left' if left > 0 else 'right'}")
    if abs(turned) > UNTURNED:
        told.append(
            f"turned {math.degrees(abs(turned)):.2g} degrees to the "
            f"{'left' if turned > 0 else 'right'}"
        )
    return ", ".join(told) or "beside it"


def wall_name(step: Step, wall: int) -> str:
    """A wall by the number of its edge,
    counted from 1 in the file's order, and its polygon's name.
    """
    return "no wall" if wall < 0 else edge_of(walls_of(step), wall)


def edge_of(walls: Walls, wall: int) -> str:
    """The same of a wall that there is; a circle has no edges to tell apart."""
    name, edge = walls.name(wall)
    return name if walls.is_round(wall) else f"edge {edge + 1} of {name}"


def corners(step: Step, wall: int) -> str:
    """From which corner to which a wall goes, or about which centre."""
    walls = walls_of(step)
    if walls.is_round(wall):
        x, y, radius = walls.circles[wall - len(walls.segments)].tolist()
        return f"about {point(x, y)}, with the radius {number(radius)} m"
    a, b = walls.segments[wall].tolist()
    return f"from {point(*a)} to {point(*b)}"


def walls_of(step: Step) -> Walls:
    """The walls that the beam of a step may meet, as the filter is told."""
    assert isinstance(step.entry.given, Reading)
    return cast("Beam", bare(step.entry.given.sensor)).walls


def origin(step: Step) -> Array:
    """From where the estimate lets the sensor of a step look : (3,)"""
    assert isinstance(step.entry.given, Reading)
    return place_of(step.entry.given.sensor, posed(step.prior, step.layout).mean)
