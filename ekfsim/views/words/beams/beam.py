"""What can be said of a beam to a wall:
where it ends in the filter's map, and where else it might have ended.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely

from ekfsim.diagnostics.ambiguity import BeamSensor, Sighting, sighting_of
from ekfsim.filters.belief import Refused
from ekfsim.floor import BOUNDARY, Map
from ekfsim.geometry import Array
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.mounted import bare
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.picture.sights import beam_length
from ekfsim.views.picture.written.lettering import shortened
from ekfsim.views.words.beams.told import elsewhere, origin, others_met
from ekfsim.views.words.numbers import length

IN_METRES = re.compile(r"([\d.e-]+) m\b")
TOUCHING = 1e-9  # of the range: what rounding makes of an end on the wall


class Probe(NamedTuple):
    """A beam from another pose that the filter holds possible,
    where it meets another wall or none.
    """

    pose: Array  # (3,) where it starts, in m, and its direction, in rad
    range: float  # m, nan where it meets no wall


@dataclass(frozen=True, slots=True)
class Beam:
    """A beam as it is drawn: from the estimate before the update, in the filter's map."""

    pose: Array  # (3,) where it starts, in m, and its direction, in rad
    measured: float  # m, nan where there was no echo
    predicted: float  # m, nan where no wall was expected
    refused: Refused
    ambiguous: bool
    grazing: float | None  # rad between beam and wall, where that is little
    probes: tuple[Probe, ...]
    # where the first of them starts and what they meet: "from 0.3 m to the left it would meet …"
    doubt: str
    walls: tuple[Array, ...]  # (n, 2) m each, the other walls that they meet, from end to end
    # whether the measured end lies in, on or behind a wall rather than in the air before it
    solid: bool
    ending: str  # the same in words: "in the air, 4 cm short of desk"
    reaching: bool = True  # whether the sensor meets a wall however far; an ultrasonic one does not


def beam(step: Step, scene: Scene) -> Beam | None:
    """The beam of a step, None where it is of no sensor that has one."""
    given, correction, sighting = step.entry.given, step.correction, sighting_of(step)
    if not isinstance(given, Reading) or correction is None or sighting is None:
        return None
    sensor = bare(given.sensor)
    if not isinstance(sensor, BeamSensor):
        return None
    start, wall = origin(step), int(sighting.wall)
    pose = start + np.array([0.0, 0.0, sensor.bearing])
    measured, predicted = (
        beam_length(sensor, float(given.z[0])),
        beam_length(sensor, float(correction.predicted[0])),
    )
    others = [wall for wall in other_walls(sensor, sighting) if wall >= 0]
    solid, ending = False, ""
    if not math.isnan(measured):
        end = pose[:2] + measured * np.array([math.cos(pose[2]), math.sin(pose[2])])
        name = sensor.walls.name(wall)[0] if wall >= 0 else ""
        gap = measured - predicted if wall >= 0 and not correction.tangent else math.nan
        solid, ending = landing(scene.world.told.map, end, gap, name, TOUCHING * measured)
    return Beam(
        pose,
        measured,
        predicted,
        Refused(int(correction.refused)),
        bool(sighting.ambiguous),
        float(sighting.incidence) if sighting.grazing else None,
        tuple(astray(sensor, sighting)),
        doubt(sensor, sighting, start) if sighting.ambiguous else "",
        tuple(sensor.walls.outline(wall) for wall in others),
        solid,
        ending,
        reaching=isinstance(sensor, Laser),
    )


def landing(floor: Map, end: Array, gap: float, wall: str, tolerance: float) -> tuple[bool, str]:
    """Whether a beam's end lies in a wall, and where it lies, in words.

    end : (2,) m; gap : m by which the beam is longer than it is expected to be, nan where no wall
    is expected; wall : the name of the expected one
    """
    if abs(gap) <= tolerance:
        return True, f"on {called(wall)}"
    point = shapely.Point(end)
    boundary, areas = floor.areas
    for obstacle, area in zip(floor.obstacles, areas, strict=True):
        if area.contains(point):
            return True, f"inside {called(obstacle.name)}" + (
                f", {length(gap)} too far" if gap > 0 else ""
            )
    if boundary is not None and not boundary.contains(point):
        return True, "outside the room" + (f", {length(gap)} too far" if gap > 0 else "")
    if gap > 0:
        return True, f"{length(gap)} behind the edge of {called(wall)}"
    return False, "in the air" + (f", {length(-gap)} short of {called(wall)}" if gap < 0 else "")


def astray(sensor: BeamSensor, sighting: Sighting) -> Iterator[Probe]:
    """The beams from other poses that meet another wall line than the estimate's beam does, or
    none.
    """
    for i in np.flatnonzero(sighting.astray):
        yield Probe(
            sighting.probes[i] + np.array([0.0, 0.0, sensor.bearing]),
            float(sighting.probe_ranges[i]),
        )


def other_walls(sensor: BeamSensor, sighting: Sighting) -> list[int]:
    """The walls that the beam would meet instead, −1 for none, in the order of the poses."""
    met = others_met(sensor.walls, sighting)
    return [int(sighting.probe_walls[i]) for i in met]


def doubt(sensor: BeamSensor, sighting: Sighting, x: Array) -> str:
    """Why a beam from x (3,) is ambiguous: a pose that disagrees, what the beam would meet from
    there, and what from the others.
    """
    first = next(others_met(sensor.walls, sighting))
    place = IN_METRES.sub(
        lambda found: length(float(found[1])), elsewhere(x, sighting.probes[first])
    ).replace(" degrees to the", "°")
    met, *more = (_edge_of(sensor, wall) for wall in other_walls(sensor, sighting))
    others = f" ({' or '.join(more)} from others)" if more else ""
    return f"from {place} it would meet {met}{others}, not {_edge_of(sensor, int(sighting.wall))}"


def _edge_of(sensor: BeamSensor, wall: int) -> str:
    if wall < 0:
        return "no wall"
    name, edge = sensor.walls.name(wall)
    if sensor.walls.is_round(wall):
        return called(name)
    return f"edge {edge + 1} of {called(name)}"


def called(name: str) -> str:
    """A wall as it is named in a sentence."""
    return "the room's wall" if name == BOUNDARY else shortened(name, 24)
