"""What a reader of drawn plans finds, shape after shape → a Plan."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from ekfsim.files.maps.plan import Asked, Circle, Line, Outline, Plan, Start
from ekfsim.geometry import Array
from ekfsim.world import Landmark

SAME_AREA = 1e-9  # of the whole
POKE = 1e-3  # of its length: how far what lies in a room may reach into its wall


@dataclass
class Drawing:
    """Shapes in m, in the order of the file."""

    outlines: list[Outline] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)
    circles: list[Circle] = field(default_factory=list)
    landmarks: list[Landmark] = field(default_factory=list)
    told: list[str] = field(default_factory=list)
    left_out: dict[str, list[str]] = field(default_factory=dict)  # why: what

    def outline(self, name: str, ring: Array, holes: Iterable[Array] = ()) -> None:
        """What takes up room: rings (n, 2), which may repeat their first point at their end."""
        outer, *inner = (once(one) for one in (ring, *holes))
        if len(outer) < 3 or shapely.Polygon(outer).area == 0:
            self.leave_out("encloses nothing", name)
            return
        inner = [hole for hole in inner if len(hole) >= 3 and shapely.Polygon(hole).area > 0]
        parts = _untouched(outer, inner)
        self.outlines += [Outline(name, points, holes) for points, holes in parts]

    def line(self, name: str, points: Array) -> None:
        """A wall from point to point, (n, 2)."""
        kept = without_repeats(points)
        if len(kept) < 2:
            self.leave_out("is a line without a length", name)
        else:
            self.lines.append(Line(name, kept))

    def circle(self, name: str, x: float, y: float, radius: float) -> None:
        """A round thing."""
        if radius > 0:
            self.circles.append(Circle(name, x, y, radius))
        else:
            self.leave_out("is a circle without a radius", name)

    def landmark(self, id: int, x: float, y: float) -> None:
        """What a sensor can tell from the others of its kind."""
        if id in {mark.id for mark in self.landmarks}:
            self.leave_out("is a landmark whose id came before", str(id))
        else:
            self.landmarks.append(Landmark(id, x, y))

    def leave_out(self, why: str, what: str) -> None:
        """Note what no world can hold."""
        self.left_out.setdefault(why, []).append(what)

    def plan(
        self, name: str, asked: Asked, start: Start | None = None, edge: Array | None = None
    ) -> Plan:
        """All of it, with what is to be told. edge : (n, 2) m, the room's, where the file tells"""
        outlines = self.outlines
        told = [*self.told]
        for why, names in self.left_out.items():
            verb = {"is": ("is", "are"), "has": ("has", "have")}.get(why.split()[0], ("does", "do"))
            others = len(names) - 1
            more = f", and so {verb[others > 1]} {others} more" if others else ""
            told.append(f"{names[0]!r} {why}{more}: left out")
        lines = list(self.lines)
        if asked.outlines == "walls":
            lines += [
                Line(one.name, np.vstack([ring, ring[:1]]))
                for one in outlines
                for ring in (one.points, *one.holes)
            ]
            outlines = []
        boundary = edge if asked.boundary == "auto" else None
        if edge is None and asked.boundary == "auto" and (room := self._room(outlines)) is not None:
            told.append(
                f"{room.name!r} lies about all else, and is taken for the room's boundary; "
                "--boundary none makes an obstacle of it"
            )
            boundary = room.points
            pieces = [
                Outline(f"{room.name} hole {n}", hole) for n, hole in enumerate(room.holes, 1)
            ]
            outlines = [*(one for one in outlines if one is not room), *pieces]
        return Plan(
            name, boundary, tuple(outlines), tuple(lines), tuple(self.circles),
            tuple(self.landmarks), start, tuple(told),
        )  # fmt: skip

    def _room(self, outlines: Sequence[Outline]) -> Outline | None:
        """The outline about all else, whose inside is where a robot drives; None where there is
        none. A ring of walls, in whose hole all else lies, is an obstacle as it stands.
        """
        if not outlines:
            return None
        areas = [shapely.Polygon(one.points).area for one in outlines]
        room = outlines[int(np.argmax(areas))]
        others = [
            *(shapely.Polygon(one.points) for one in outlines if one is not room),
            *(shapely.LineString(one.points) for one in self.lines),
            *(shapely.Point(one.x, one.y).buffer(one.radius) for one in self.circles),
            *(shapely.Point(one.x, one.y) for one in self.landmarks),
        ]
        outer = shapely.Polygon(room.points)
        hair = POKE * np.hypot(*np.ptp(room.points, axis=0))
        if not outer.is_valid or not np.all(shapely.covers(outer.buffer(hair), others)):
            return None
        solid = shapely.Polygon(room.points, room.holes)
        if room.holes and others:
            return room if np.any(shapely.intersects(solid.buffer(-hair), others)) else None
        return None if room.holes and solid.area < outer.area / 2 else room


def once(ring: Array) -> Array:
    """A ring without its first point at its end, and without points that repeat the one before."""
    ring = without_repeats(ring)
    return ring[:-1] if len(ring) > 1 and np.array_equal(ring[0], ring[-1]) else ring


def without_repeats(points: Array) -> Array:
    """A line without points that repeat the one before : (n, 2)"""
    kept = np.ones(len(points), dtype=bool)
    kept[1:] = np.any(np.diff(points, axis=0) != 0, axis=1)
    return points[kept]


def _untouched(ring: Array, holes: Sequence[Array]) -> list[tuple[Array, tuple[Array, ...]]]:
    """Outlines that touch themselves nowhere, of one that may: a slit that leads to a hole and back
    (a keyhole) becomes the hole. One that crosses itself stays as it is, and is refused by whoever
    reads the world.
    """
    shape = shapely.Polygon(ring, holes)
    if shape.is_valid:
        return [(ring, tuple(holes))]
    mended = shapely.make_valid(shape, method="structure")
    parts = [one for one in shapely.get_parts(mended) if one.geom_type == "Polygon"]
    area = sum(one.area for one in parts)
    if not parts or abs(area - shape.area) > SAME_AREA * abs(shape.area):
        return [(ring, tuple(holes))]
    return [
        (
            once(shapely.get_coordinates(one.exterior)),
            tuple(once(shapely.get_coordinates(hole)) for hole in one.interiors),
        )
        for one in parts
    ]
