"""Worlds for recorded logs, folders with small logs, and what a filter makes of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scenes import SILENT

from ekfsim.files.keys.recorded.recording import SYSTEM_OF, RecordingKeys
from ekfsim.files.logs import read_log
from ekfsim.filters.belief import posed
from ekfsim.floor import Map
from ekfsim.geometry.angles import wrap
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.systems import SYSTEMS
from ekfsim.systems.instrument import Landmark
from ekfsim.world import Told, World

SHARED = Path(__file__).resolve().parents[3] / ".." / "shared" / "data"
PYLON = (Landmark(1, 5.0, -5.0),)
MARKS = tuple(
    Landmark(i, x, y) for i, (x, y) in enumerate([(3.0, 2.0), (8.0, 3.0), (2.0, 6.0), (-4.0, 1.0)])
)
CLOSET = Map(np.array([[-1, -1], [3, -1], [3, 3], [-1, 3.0]]))


def shared(name):
    if not (SHARED / name).exists():
        pytest.skip(f"the recorded logs of {name} are not here")
    return SHARED / name


def world(format, landmarks=(), instruments=None, robot=None, floor=Map(), start=(0.0, 0.0, 0.0)):  # noqa: B008
    name = SYSTEM_OF[format]
    system, start = SYSTEMS[name], np.array(start)
    return World(
        "test", floor, start, np.zeros(3), SILENT, Told(start, np.zeros(3), SILENT, floor),
        landmarks=landmarks,
        system=name, robot=robot or system.robot, instruments=instruments or system.instruments,
    )  # fmt: skip


def read(format, path, place=None, reading="corrected"):
    return read_log(
        RecordingKeys(format=format),
        path,
        place or world(format, PYLON if format == "pylon" else ()),
        reading,
    )


def steps_of(format, path, place=None, reading="corrected", **settings):
    """The steps of a filter on a log, the scene, and the warnings."""
    place = place or world(format, PYLON if format == "pylon" else ())
    found = read_log(RecordingKeys(format=format), path, place, reading)
    if found.landmarks is not None:
        place = replace(place, landmarks=found.landmarks)
    scene = Scene(place, log=found.log, reading=reading, **settings)
    return list(play(scene)), scene, found.warnings


def errors(steps, layout):
    """Position and heading errors at every judged instant, after its last update : (n, 3)"""
    last = {step.entry.t: step for step in steps if step.entry.truth is not None}
    e = np.array(
        [posed(s.posterior, layout).mean - s.entry.truth for s in last.values() if s.entry.judged]
    )
    return np.column_stack([e[:, :2], wrap(e[:, 2])])


def rmse(steps, scene):
    e = errors(steps, scene.world.layout)
    return float(np.sqrt(np.mean(np.sum(e[:, :2] ** 2, axis=1))))


def lay(folder, **files):
    """Write files, `_` for `-` and `.` where names cannot hold them: given as a dict of name →
    text."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder


def table(header, rows):
    return "\n".join([header, *(",".join(map(repr, row)) for row in rows), ""])
