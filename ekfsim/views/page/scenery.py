"""What stays the same from view to view of a page: the world, who watches, and how everything
looks; and how much of the plane is shown.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ekfsim.floor import Map, WallLine
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_factor, radius_factor
from ekfsim.printable import in_a_line
from ekfsim.scene import Scene
from ekfsim.views.page.numbers import length, points, short
from ekfsim.views.picture import artists
from ekfsim.views.picture.belief import ghost, warned, ways
from ekfsim.views.picture.belief.belief import COVERED
from ekfsim.views.picture.belief.others import STYLES
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.look import Look
from ekfsim.views.picture.sight_artists import FIX, OTHERWISE, recorded_fixes
from ekfsim.views.picture.written.lettering import shortened
from ekfsim.views.words.captions import conditioned_label, cone_label, ellipse_label

if TYPE_CHECKING:
    from shapely import Polygon

FAR = 1e4  # m from the origin of its grid, from which on a browser's numbers are too coarse
FIXES = 1000  # that were recorded and not used; of many more, about as many are drawn
NAMES = {"theta": "θ", "phi": "φ", "thetadot": "θ̇", "xdot": "ẋ", "ydot": "ẏ", "theta_prev": "θ₋"}


def origin_of(limits: Limits) -> Array:
    """From where a page counts : (2,) m. It is that of the world, unless the world is far away."""
    middle = [(limits.left + limits.right) / 2, (limits.bottom + limits.top) / 2]
    return np.round(middle) if max(map(abs, middle)) > FAR else np.zeros(2)


def framed(limits: Limits, origin: Array) -> list[Any]:
    """How much of the plane is shown: left, bottom, right, top"""
    (x, y), edges = origin.tolist(), (limits.left, limits.bottom, limits.right, limits.top)
    return [length(edge - start) for edge, start in zip(edges, (x, y, x, y), strict=True)]


def scenery(scene: Scene, look: Look, origin: Array) -> dict[str, Any]:
    """All of it, by name."""
    world, told = scene.world, scene.world.told.map
    fixed: dict[str, Any] = {
        "origin": [length(value) for value in origin.tolist()],
        "world": _map(world.map, origin),
        "landmarks": [
            [*points(np.array([[mark.x, mark.y]]), origin), str(mark.id)]
            for mark in world.landmarks
        ],
        "filters": list(_filters(scene)),
        "state": [NAMES.get(name, name) for name in world.layout.names],
        "places": list(world.layout.places),
        "driven": not scene.commanded,
        "covered": COVERED,
        "k": short(radius_factor(look.probability)),
        "cone": short(cone_factor(look.probability)),
        "labels": {
            "ellipse": ellipse_label(look.probability), "cone": cone_label(look.probability)
        },
    }  # fmt: skip
    if told is not world.map:
        fixed["told"] = _map(told, origin)
    if world.expected_path is not None:
        fixed["meant"] = points(world.expected_path, origin)
    if look.conditional:
        fixed["conditional"] = [conditioned_label(look.probability, sign) for sign in (1, -1)]
    if scene.log is not None:
        index, fixes = recorded_fixes(scene.log.entries)
        every = max(1, len(fixes) // FIXES)
        fixed["fixes"] = [index[::every].tolist(), points(fixes[::every], origin)]
    return fixed


def inks() -> str:
    """The colours of the pictures, as a style sheet names them."""
    named = {
        "blue": artists.BLUE, "sky": artists.SKY, "green": artists.GREEN,
        "vermillion": artists.VERMILLION, "purple": artists.PURPLE, "orange": artists.ORANGE,
        "outside": artists.OUTSIDE, "floor": artists.FLOOR, "obstacle": artists.OBSTACLE,
        "edge": artists.EDGE, "truth": artists.TRUTH, "meant": artists.MEANT,
        "crowd": artists.CROWD, "ghost": ghost.GHOST, "alarm-ink": warned.ALARM, "fix": FIX,
    }  # fmt: skip
    dashed = {
        "alarm-dashes": dashes(warned.ALARM_DASHES, warned.ALARM_WIDTH),
        "true-dashes": dashes(ways.TRUE_DASHES, 1.1),
        "reckoned-dashes": dashes(ways.RECKONED_DASHES, 1.1),
        "otherwise-dashes": dashes(OTHERWISE, 3.5),
    }
    told = (f"--{name}: {value};" for name, value in (named | dashed).items())
    return f":root {{ {' '.join(told)} }}\n"


def dashes(style: artists.Dashes, width: float) -> str:
    """A picture's dashes, which are told in widths of a line in points, in pixels of a page.

    >>> dashes((0, (5, 1.5)), 1.5)
    '10 3'
    """
    assert not isinstance(style, str)
    return " ".join(f"{each * width * 96 / 72:.3g}" for each in style[1])


def _filters(scene: Scene) -> Iterator[dict[str, Any]]:
    """Those that watch; each but the first in its own colour, its own dashes."""
    for number, name in enumerate(scene.watching):
        told: dict[str, Any] = {"name": in_a_line(name)}
        if number:
            style = STYLES[(number - 1) % len(STYLES)]
            told |= {"ink": style.color, "mark": style.marker, "dashes": dashes(style.dashes, 1.6)}
        yield told


def _map(floor: Map, origin: Array) -> dict[str, Any]:
    room = [] if floor.boundary is None else points(floor.boundary, origin)
    _, areas = floor.areas
    obstacles = [
        {
            "name": in_a_line(shortened(each.name, 20)),
            "ring": points(each.outline, origin),
            "at": points(_middle(area), origin),
        }
        for each, area in zip(floor.obstacles, areas, strict=True)
    ]
    lines = [points(line.points, origin) for line in floor.lines]
    names = [
        {"name": in_a_line(shortened(line.name, 20)), "at": points(_middle_of(line), origin)}
        for line in floor.named_lines()
    ]
    return {"boundary": room, "obstacles": obstacles, "walls": lines, "names": names}


def _middle_of(line: WallLine) -> Array:
    """The middle of a line's longest part, where its name stands : (1, 2) m"""
    a, b = line.points[:-1], line.points[1:]
    middles: Array = (a + b) / 2
    return middles[[np.argmax(np.linalg.norm(b - a, axis=-1))]]


def _middle(area: "Polygon") -> Array:
    """Where an obstacle's name stands in it : (1, 2) m"""
    middle = area.centroid if area.contains(area.centroid) else area.representative_point()
    return np.array([[middle.x, middle.y]])
