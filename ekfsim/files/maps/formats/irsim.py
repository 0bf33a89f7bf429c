"""A world of ir-sim: circles, rectangles, polygons and lines, each with its state."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.maps.drawn.drawing import Drawing
from ekfsim.files.maps.pixels.cells import Reading
from ekfsim.files.maps.plan import Asked, Plan, Start
from ekfsim.files.maps.reading import Head
from ekfsim.files.yaml.marked import Node
from ekfsim.geometry import Array
from ekfsim.printable import quoted

UNSAID = (1.0, 1.0, 0.0)  # the state of an object that names none, in ir-sim 2
SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1.0]])  # a polygon that names no vertices
OCCUPIED = 0.5  # of a picture: darker cells are walls
SQUARE_CELLS = 1e-3  # how far a cell's sides may differ, of their length


class Pose(NamedTuple):
    """Where an object stands, m, m, rad."""

    x: float
    y: float
    theta: float

    def placed(self, points: Array) -> Array:
        """Its own points (n, 2) in the world."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        return np.asarray(points @ np.array([[c, s], [-s, c]]) + (self.x, self.y))

    def then(self, inner: "Pose") -> "Pose":
        """Where a part of it stands."""
        ((x, y),) = self.placed(np.array([[inner.x, inner.y]])).tolist()
        return Pose(x, y, self.theta + inner.theta)


def read(head: Head, asked: Asked) -> Plan:
    """The plan of an ir-sim world: what stands still, the world's edge, and the first robot.

    Raises InputError with all mistakes in what is read of it, UsageError where its picture cannot
    be read.
    """
    file = _File(head)
    world = _World(file, head.root)
    drawing = Drawing()
    for node, number in file.listed("obstacle"):
        _Things(file, drawing).add(node, number)
    robots = list(file.listed("robot"))
    start = None
    if robots:
        x, y, theta = file.states(robots[0][0], 1)[0]
        start = x, y, math.degrees(theta)
        if len(robots) > 1:
            drawing.told.append(f"of {len(robots)} robots the first is the world's")
    if file.mistakes:
        raise InputError(file.mistakes)
    if asked.boundary == "auto":
        drawing.told.append(
            "the edge of the ir-sim world became a wall, which its beams do not see (otherwise: "
            "--boundary none)"
        )
    return _with_picture(drawing.plan(head.path.stem, asked, start, world.edge), world, head, asked)


class _File:
    """The values of the file, each checked where it is asked for."""

    def __init__(self, head: Head) -> None:
        if head.root is None:
            raise ValueError(f"{head.shown}: no mapping, and was recognised as an ir-sim world")
        self.shown, self.root = head.shown, head.root
        self.mistakes = list[Mistake]()

    def listed(self, key: str) -> Iterator[tuple[Node, int]]:
        """The objects under a key, one or a list of them, numbered from 1."""
        held = self.root.get(key)
        items = [] if held is None else held.value if isinstance(held.value, list) else [held]
        for number, node in enumerate(items, 1):
            if isinstance(node.value, dict):
                yield node, number
            elif node.value:
                self.refuse(node, key, "a mapping belongs here", "write shape: {…}, state: […]")

    def number(self, node: Node | None, key: str, default: float) -> float:
        """The number under a key of a mapping."""
        held = None if node is None else node.get(key)
        if held is None:
            return default
        if isinstance(held.value, bool) or not isinstance(held.value, int | float):
            self.refuse(held, key, "a number belongs here", f"write e.g. {default:g}")
            return default
        return float(held.value)

    def numbers(self, node: Node, key: str, least: int) -> list[float]:
        """A list of numbers."""
        items = node.value if isinstance(node.value, list) else []
        values = [
            float(item.value)
            for item in items
            if isinstance(item.value, int | float) and math.isfinite(item.value)
        ]
        if len(values) != len(items) or len(values) < least:
            self.refuse(node, key, f"{least} numbers belong here", "write e.g. [1, 2]")
            return [0.0] * least
        return values

    def points(self, node: Node, key: str) -> Array:
        """A list of points (n, 2)."""
        items = node.value if isinstance(node.value, list) else []
        return np.array([self.numbers(item, key, 2)[:2] for item in items]).reshape(-1, 2)

    def states(self, node: Node, count: int) -> list[Pose]:
        """Where an object's copies stand, as many as there are."""
        held = node.get("state")
        if held is None:
            return [Pose(*UNSAID)] * count
        items = held.value if isinstance(held.value, list) else []
        several = bool(items) and isinstance(items[0].value, list)
        poses = []
        for item in items if several else [held]:
            x, y, *rest = self.numbers(item, "state", 2)
            poses.append(Pose(x, y, rest[0] if rest else 0.0))
        return [poses[min(n, len(poses) - 1)] for n in range(count)]

    def refuse(self, node: Node, key: str, wrong: str, right: str) -> None:
        """Note a mistake at its place."""
        self.mistakes.append(Mistake(Place(self.shown, *node.mark), key, wrong, right))


class _World:
    """The world's own keys."""

    def __init__(self, file: _File, root: Node | None) -> None:
        node = None if root is None else root.get("world")
        self.width = file.number(node, "width", 10.0)
        self.height = file.number(node, "height", 10.0)
        offset = None if node is None else node.get("offset")
        self.x, self.y = (0.0, 0.0) if offset is None else file.numbers(offset, "offset", 2)[:2]
        held = None if node is None else node.get("obstacle_map")
        if held is not None and isinstance(held.value, dict):
            named = held.get("path") if held.get("name") is not None else None
            self.generated = named is None
            held = named
        else:
            self.generated = False
        self.picture = held.value if held is not None and isinstance(held.value, str) else None
        right, top = self.x + self.width, self.y + self.height
        self.edge = np.array([[self.x, self.y], [right, self.y], [right, top], [self.x, top]])


class _Things:
    """The obstacles of a file, one after another."""

    def __init__(self, file: _File, drawing: Drawing) -> None:
        self.file, self.drawing = file, drawing

    def add(self, node: Node, number: int) -> None:
        """An obstacle, or as many as it says."""
        named = node.get("name")
        title = str(named.value) if named is not None and named.written else f"obstacle {number}"
        placed = node.get("distribution")
        how = placed.get("name") if placed is not None else None
        unseen = node.get("unobstructed")
        moves = node.get("kinematics")
        if unseen is not None and unseen.value is True:
            self.drawing.leave_out("is unobstructed, so that nothing meets it", title)
        elif how is not None and how.value != "manual":
            self.drawing.leave_out("is placed at random", title)
        elif moves is not None and moves.get("name") is not None:
            self.drawing.leave_out("moves", title)
        else:
            count = max(1, int(self.file.number(node, "number", 1)))
            shape = node.get("shape")
            shapes = (
                [] if shape is None else shape.value if isinstance(shape.value, list) else [shape]
            )
            for n, pose in enumerate(self.file.states(node, count)):
                own = title if count == 1 else f"{title} {n + 1}"
                self.shape(shapes[min(n, len(shapes) - 1)] if shapes else None, pose, own, title)

    def shape(self, shape: Node | None, pose: Pose, name: str, title: str) -> None:
        """One shape at a pose; without one ir-sim draws a circle."""
        kind = (
            "circle"
            if shape is None or shape.get("name") is None
            else shape.nearest(("name",)).value
        )
        drawn = shape.get("random_shape") if shape is not None else None
        if drawn is not None and drawn.value is True:
            self.drawing.leave_out("has a random shape", title)
        elif kind == "circle":
            center = None if shape is None else shape.get("center")
            x, y = (0.0, 0.0) if center is None else self.file.numbers(center, "center", 2)[:2]
            x += self.file.number(shape, "wheelbase", 0.0) / 2
            ((x, y),) = pose.placed(np.array([[x, y]])).tolist()
            self.drawing.circle(name, x, y, self.file.number(shape, "radius", 0.2))
        elif kind == "rectangle":
            self.drawing.outline(name, pose.placed(self._rectangle(shape)))
        elif kind in ("polygon", "linestring"):
            held = shape.get("vertices") if shape is not None else None
            vertices = SQUARE if held is None else self.file.points(held, "vertices")
            add = self.drawing.outline if kind == "polygon" else self.drawing.line
            add(name, pose.placed(vertices))
        elif kind == "compound" and shape is not None and (parts := shape.get("parts")) is not None:
            for part in parts.value if isinstance(parts.value, list) else []:
                held = part.get("pose")
                at = (0, 0, 0) if held is None else self.file.numbers(held, "pose", 3)[:3]
                self.shape(part, pose.then(Pose(*at)), name, title)
        else:
            self.drawing.leave_out(f"has the shape {quoted(str(kind))}", title)

    def _rectangle(self, shape: Node | None) -> Array:
        """Its corners about its own origin, which lies over the rear axle where it has a wheelbase.

        (4, 2)
        """
        length, width = (self.file.number(shape, key, 1.0) for key in ("length", "width"))
        base = self.file.number(shape, "wheelbase", 0.0)
        rear = -length / 2 if base == 0 else -(length - base) / 2
        low, high = -width / 2, width / 2
        front = rear + length
        return np.array([[rear, low], [front, low], [front, high], [rear, high]])


def _with_picture(plan: Plan, world: _World, head: Head, asked: Asked) -> Plan:
    """The plan with the walls of the world's picture, where it has one."""
    if world.generated:
        return replace(plan, told=(*plan.told, "its obstacle_map is made by chance: left out"))
    if world.picture is None:
        return plan
    from ekfsim.files.maps.pixels.image import grey_of
    from ekfsim.files.maps.pixels.rooms import plan_of

    file = head.path.parent / world.picture
    grey = grey_of(file, str(file))
    rows, columns = grey.bright.shape
    cell = world.width / columns
    told = list(plan.told)
    if abs(world.height / rows - cell) > SQUARE_CELLS * cell:
        told.append(
            f"the cells of {world.picture} are no squares, {cell:.3g} by {world.height / rows:.3g} "
            "m: its walls are left out"
        )
        return replace(plan, told=tuple(told))
    reading = Reading(False, OCCUPIED, OCCUPIED, "trinary")
    origin: Start = (world.x, world.y, 0.0)
    drawn = plan_of(
        plan.name, grey, reading, cell, origin, replace(asked, unknown="free"), told, head.shown
    )
    return replace(
        plan, outlines=(*plan.outlines, *drawn.outlines), told=drawn.told, scan=drawn.scan
    )
