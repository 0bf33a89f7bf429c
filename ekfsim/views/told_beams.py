"""What is said of a beam: the wall that it was expected to meet, and what is doubtful about that."""

import math
from typing import Protocol, runtime_checkable

import numpy as np

from ekfsim.geometry.walls import Walls
from ekfsim.models.laser import GRAZING, Sighting
from ekfsim.records import Reading, Step
from ekfsim.views.numbers import number, turn


@runtime_checkable
class Beam(Protocol):
    """A sensor that sends a beam against walls."""

    @property
    def walls(self) -> Walls:
        """Of the map that the filter is told."""


def doubts(step: Step, guarded: bool) -> str:
    """What is doubtful about a beam before its reading is used; nothing of a sensor that sends none."""
    sighting = step.sighting
    if sighting is None:
        return ""
    told = ""
    if sighting.ambiguous and guarded:
        told += (
            f"This beam is ambiguous: expected to meet {_wall_name(step, int(sighting.wall))}, but from a pose within "
            f"3 sigma it would meet {_others(step, sighting)}\n"
        )
    if sighting.grazing:
        told += (
            f"This beam grazes its wall at {turn(float(sighting.incidence))} degrees (below {turn(GRAZING)}): "
            "a small turn would move its end far\n"
        )
    return told


def expected_wall(step: Step) -> str:
    """Which wall the beam was expected to meet, and at which angle; nothing of a sensor that sends none."""
    if step.sighting is None:
        return ""
    incidence = number(math.degrees(float(step.sighting.incidence)))
    return f"It was expected to meet {_wall_name(step, int(step.sighting.wall))} at {incidence} degrees\n"


def _others(step: Step, sighting: Sighting) -> str:
    """The other walls that the beam would meet from the poses around the estimate, each named once."""
    line = np.append(_walls(step).line, -1)  # the wall −1, none, takes the last
    others = sighting.probe_walls[line[sighting.probe_walls] != line[sighting.wall]]
    return " or ".join(dict.fromkeys(_wall_name(step, wall) for wall in others.tolist()))


def _wall_name(step: Step, wall: int) -> str:
    if wall < 0:
        return "no wall"
    name, edge = _walls(step).name(wall)
    return f"edge {edge} of {name}"


def _walls(step: Step) -> Walls:
    assert isinstance(step.entry.given, Reading)
    assert isinstance(step.entry.given.sensor, Beam)
    return step.entry.given.sensor.walls
