"""What a page draws of a reading: the same lines and marks as a picture."""

from typing import Any

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.page.numbers import points
from ekfsim.views.picture.sights import Sight, sight
from ekfsim.views.words.beams.beam import Beam, Probe, beam

AIR, WALL, FIX = "air", "wall", "fix"  # what a reading ends in, as the marks tell


def seen(step: Step, scene: Scene, origin: Array, far: float) -> dict[str, Any] | None:
    """What is drawn of a step's reading, None where it has none. Keys of what is not there are
    left out. origin : (2,) m; far : m, how long a beam is drawn that meets nothing
    """
    read = beam(step, scene) or sight(step)
    match read:
        case Beam():
            drawn = _of_beam(read, origin, far)
        case Sight():
            drawn = _of_sight(read, origin)
        case _:
            return None
    return {key: value for key, value in drawn.items() if value not in (None, [], False)}


def _of_beam(read: Beam, origin: Array, far: float) -> dict[str, Any]:
    echo = not np.isnan(read.measured)
    end = _ahead(read.pose, read.measured)[1:] if echo else np.empty((0, 2))
    expected = not np.isnan(read.predicted)
    way = _ahead(read.pose, read.predicted) if expected else np.empty((0, 2))
    return {
        "line": points(_ahead(read.pose, read.measured if echo else far), origin),
        "style": "silent" if not echo else "refused" if read.refused else "used",
        "end": points(end, origin),
        "in": WALL if read.solid else AIR,
        "hollow": bool(read.refused) or not read.solid,
        "way": points(way, origin),
        "expected": points(way[1:], origin),
        "probes": [_probe(probe, origin, far) for probe in read.probes],
        "walls": [points(wall, origin) for wall in read.walls],
        "word": "beam",
    }


def _of_sight(read: Sight, origin: Array) -> dict[str, Any]:
    return {
        "line": points(read.line, origin),
        "style": "refused" if read.refused != Refused.NOT else "used",
        "end": points(read.end, origin),
        "in": FIX if read.fix else AIR,
        "hollow": read.refused != Refused.NOT,
        "way": points(read.way, origin),
        "expected": points(read.expected, origin),
        "place": points(read.place, origin),
        "word": read.word,
    }


def _probe(probe: Probe, origin: Array, far: float) -> list[Any]:
    """A beam from another pose that the filter holds possible."""
    length = far if np.isnan(probe.range) else probe.range
    return points(_ahead(probe.pose, length), origin)


def _ahead(pose: Array, length: float) -> Array:
    """From a pose straight ahead : (2, 2) m"""
    direction = np.array([np.cos(pose[2]), np.sin(pose[2])])
    return np.stack([pose[:2], pose[:2] + length * direction])
