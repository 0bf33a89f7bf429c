"""A simulated run of the classroom → the files that a course hands out.

They hold what the filter is given and told, and nothing else: no truth, no faults, no world as it
is. Neither do they name the scene, the seed and the run, for whoever has these can play the truth:
only beside the truth itself they stand, in about.txt.
"""

import json
import math
from collections.abc import Iterable, Iterator
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.keys.fields import aliases
from ekfsim.files.keys.world import NoiseKeys
from ekfsim.files.logs.degrees import degrees
from ekfsim.files.logs.formats.classroom import COLUMNS, ENTRIES, TRUTH, TRUTH_COLUMNS, WORLD
from ekfsim.files.results.writing import whole_folder
from ekfsim.files.scenes.checking.polygons import FloorPlan
from ekfsim.geometry import Array
from ekfsim.models.sensors.laser import Laser
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.version import VERSION
from ekfsim.world import Obstacle, RoundObstacle, Told

ABOUT = "about.txt"  # only beside the truth
NAME = "classroom"  # of the world: its own may tell what is wrong in it
AXES = ("x", "y", "theta")


def hand_out(
    scene: Scene, entries: Iterable[Entry], out: Path, force: bool, with_truth: bool
) -> None:
    """Write what the filter is given in a run, and what it is told, into a folder.

    Raises UsageError where the folder may not be written, or the filter is told a start at which no
    world file can have one.
    """
    told = scene.world.told
    _refuse_start(scene, told)
    with whole_folder(out, ENTRIES, WORLD, TRUTH, ABOUT, force=force) as folder:
        happened = tuple(entries)
        files = {ENTRIES: _table(COLUMNS, _rows(happened)), WORLD: "".join(_world(told))}
        if with_truth:
            files[TRUTH] = _table(TRUTH_COLUMNS, _poses(happened))
            files[ABOUT] = f"A recorded log: {told_in_a_line(scene)}\n"
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")


def _rows(entries: Iterable[Entry]) -> Iterator[tuple[str, ...]]:
    """A row for each move and each beam; of texts and kidnappings a filter is told nothing."""
    for entry in entries:
        match entry.given:
            case Control(_, u):
                distance, angle = u.tolist()
                yield f"{entry.index}", "move", repr(distance), degrees(angle), "", ""
            case Reading(Laser() as laser, z):
                echo = "" if math.isnan(z[0]) else repr(float(z[0]))
                yield f"{entry.index}", "sense", "", "", degrees(laser.bearing), echo


def _poses(entries: Iterable[Entry]) -> Iterator[tuple[str, ...]]:
    """The true pose at the start, and after each of the same rows."""
    for entry in entries:
        if (entry.given is not None or entry.index == 0) and entry.truth is not None:
            x, y, θ = entry.truth.tolist()
            yield f"{entry.index}", repr(x), repr(y), degrees(θ)


def _table(columns: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    return "".join(f"{','.join(row)}\n" for row in (columns, *rows))


def _world(told: Told) -> Iterator[str]:
    """A world file in which all is as the filter is told."""
    yield f"# What the filter is told, as ekfsim {VERSION} recorded it: m, and angles in degrees.\n"
    yield "# The truth may differ in all of it.\n"
    yield f"name: {NAME}\n"
    if told.map.boundary is not None:
        yield f"boundary: {_points(told.map.boundary)}\n"
    if told.map.obstacles:
        yield "obstacles:\n"
    for obstacle in told.map.obstacles:
        name = json.dumps(obstacle.name, ensure_ascii=False)
        yield f"  - {{name: {name}, {_shape(obstacle)}}}\n"
    if told.map.lines:
        yield "walls:\n"
    for line in told.map.lines:
        name = json.dumps(line.name, ensure_ascii=False)
        yield f"  - {{name: {name}, points: {_points(line.points)}}}\n"
    sigma = f", sigma: {{{_pose(told.sigma)}}}" if told.sigma.any() else ""
    yield f"start: {{{_pose(told.start)}{sigma}}}\nnoise:\n"
    for name, key in aliases(NoiseKeys).items():
        yield f"  {key}: {getattr(told.noise, name)!r}\n"


def _shape(obstacle: Obstacle | RoundObstacle) -> str:
    if isinstance(obstacle, Obstacle):
        return f"points: {_points(obstacle.points)}"
    x, y = obstacle.centre.tolist()
    return f"circle: {{x: {x!r}, y: {y!r}, radius: {obstacle.radius!r}}}"


def _points(corners: Array) -> str:
    return repr(corners.tolist())


def _pose(pose: Array) -> str:
    x, y, θ = pose.tolist()
    return f"x: {x!r}, y: {y!r}, theta: {degrees(θ)}"


def _refuse_start(scene: Scene, told: Told) -> None:
    """Raise UsageError where no world file can have the start that the filter is told."""
    x, y, _ = told.start.tolist()
    for wrong in FloorPlan.of(told.map).in_the_way(x, y):
        raise UsageError(
            f"{scene.commands_source}: cannot be recorded: the filter is told a start at {wrong} "
            "of its own map; tell it one where the robot can stand"
        )
