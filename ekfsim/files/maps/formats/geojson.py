"""GeoJSON (RFC 7946): polygons, lines and points, in longitude and latitude."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ekfsim.errors import InputError, Mistake
from ekfsim.files.maps.drawn.drawing import Drawing
from ekfsim.files.maps.drawn.units import places
from ekfsim.files.maps.json_text import place_of
from ekfsim.files.maps.plan import Asked, Plan
from ekfsim.files.maps.reading import Head
from ekfsim.files.yaml.marked import Path as Route
from ekfsim.files.yaml.marked import field_of
from ekfsim.geometry import Array
from ekfsim.printable import quoted

MOST_TOLD = 20
KINDS = (
    *("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon"),
    "GeometryCollection",
)
IDS = ("id", "landmark", "ref", "marker")


def read(head: Head, asked: Asked) -> Plan:
    """The plan of a GeoJSON file: polygons are obstacles, lines are walls, points with an id are
    landmarks, points with a radius round things.

    Raises InputError with all mistakes in the file, UsageError where its coordinates are none of
    the earth and nothing says what they are.
    """
    found = _Shapes(head)
    found.all_of(head.data)
    if found.mistakes:
        more = len(found.mistakes) - MOST_TOLD
        last = (
            [Mistake(found.mistakes[MOST_TOLD].place, "", f"and {more} more mistakes")]
            if more > 0
            else []
        )
        raise InputError([*found.mistakes[:MOST_TOLD], *last])
    told = list[str]()
    every = [ring for shape in found.shapes for ring in shape.rings]
    points = np.vstack(every) if every else np.empty((0, 2))
    if found.crs and asked.units is None:
        place = place_of(head.raw, head.shown, ("crs",))
        right = "where they are metres, say --units m; else save it as longitude and latitude"
        wrong = f"the coordinates are of {found.crs}"
        raise InputError([Mistake(place, "crs", wrong, right)])
    metres = places(points, asked.units or "degrees", head.shown, told)
    drawing = Drawing(told=told)
    for shape in found.shapes:
        shape.draw(drawing, [metres(ring) for ring in shape.rings])
    for why, count in found.left_out.items():
        told.append(f"{why}: {count} left out" if count > 1 else f"{why}: left out")
    return drawing.plan(head.path.stem, asked)


class Shape:
    """One polygon, line or point, as the file has it."""

    def __init__(self, kind: str, name: str, rings: list[Array], about: dict[str, Any]) -> None:
        self.kind, self.name, self.rings, self.about = kind, name, rings, about

    def draw(self, drawing: Drawing, rings: Sequence[Array]) -> None:
        """Add it to a drawing. rings : the same in m"""
        if self.kind == "Polygon":
            drawing.outline(self.name, rings[0], rings[1:])
        elif self.kind == "LineString":
            drawing.line(self.name, rings[0])
        else:
            ((x, y),) = rings[0].tolist()
            radius = _number(self.about.get("radius"))
            if radius is not None:
                drawing.circle(self.name, x, y, radius)
            elif (id := _id(self.about)) is not None:
                drawing.landmark(id, x, y)
            else:
                drawing.leave_out("is a point without an id or a radius", self.name)


class _Shapes:
    """All shapes of a file, and all mistakes in it."""

    def __init__(self, head: Head) -> None:
        self.head = head
        self.shapes = list[Shape]()
        self.mistakes = list[Mistake]()
        self.left_out = dict[str, int]()
        self.crs = ""

    def all_of(self, data: Any) -> None:
        """The shapes of a whole file."""
        if isinstance(data, dict) and isinstance(crs := data.get("crs"), dict):
            properties = crs.get("properties")
            name = str(properties.get("name", "")) if isinstance(properties, dict) else ""
            self.crs = "" if not name or "CRS84" in name or name.endswith("4326") else name
        kind = data.get("type") if isinstance(data, dict) else None
        if kind == "FeatureCollection":
            features = data.get("features")
            if not isinstance(features, list):
                self.refuse((), "'features' is missing", "it is the list of what is drawn")
                return
            for n, feature in enumerate(features):
                self.feature(feature, ("features", n), n)
        elif kind == "Feature":
            self.feature(data, (), 0)
        else:
            self.geometry(data, (), "", {})

    def feature(self, feature: Any, route: Route, number: int) -> None:
        """The shapes of one feature."""
        if not isinstance(feature, dict) or feature.get("type") != "Feature":
            self.refuse(route, "this is no Feature", 'write {"type": "Feature", …}')
            return
        properties = feature.get("properties")
        about = dict(properties) if isinstance(properties, dict) else {}
        if "id" in feature:
            about.setdefault("id", feature["id"])
        if feature.get("geometry") is None:
            named = quoted(str(about.get("name") or about.get("id") or number))
            self.leave_out(f"the geometry of the feature {named} is null")
            return
        name = next((str(about[key]) for key in ("name", "id") if _is_name(about.get(key))), "")
        self.geometry(feature["geometry"], (*route, "geometry"), name, about)

    def geometry(self, given: Any, route: Route, name: str, about: dict[str, Any]) -> None:
        """The shapes of one geometry."""
        kind = given.get("type") if isinstance(given, dict) else None
        if kind not in KINDS:
            told = (
                "this is no geometry"
                if not isinstance(kind, str)
                else f"{quoted(kind)} is no geometry"
            )
            self.refuse(route, told, f"known: {', '.join(KINDS)}")
            return
        if kind == "GeometryCollection":
            for n, part in enumerate(self._list(given.get("geometries"), (*route, "geometries"))):
                self.geometry(part, (*route, "geometries", n), name, about)
            return
        inside = (*route, "coordinates")
        coordinates = self._list(given.get("coordinates"), inside)
        if not coordinates:
            if isinstance(given.get("coordinates"), list):
                self.leave_out(f"the {kind} at {field_of(route) or 'the top'} is empty")
            return
        single = kind.removeprefix("Multi")
        parts = [(coordinates, inside)]
        if kind.startswith("Multi"):
            parts = [(part, (*inside, n)) for n, part in enumerate(coordinates)]
        for part, at in parts:
            rings = list(self._rings(single, part, at))
            if rings and all(ring is not None for ring in rings):
                kept = [ring for ring in rings if ring is not None]
                self.shapes.append(
                    Shape(single, name or f"{single} {len(self.shapes) + 1}", kept, about)
                )

    def _rings(self, kind: str, part: Any, route: Route) -> Iterator[Array | None]:
        """The points of a polygon's rings, of a line, or of a point; None where they are wrong."""
        if kind == "Point":
            yield self._points([part], route, 1, single=True)
        elif kind == "LineString":
            yield self._points(part, route, 2)
        else:
            for n, ring in enumerate(self._list(part, route)):
                points = self._points(ring, (*route, n), 4)
                if points is not None and not np.array_equal(points[0], points[-1]):
                    first, last = (f"[{x:.12g}, {y:.12g}]" for x, y in (points[0], points[-1]))
                    self.refuse(
                        (*route, n), f"the ring is not closed: it ends at {last}",
                        f"repeat its first point at its end, {first}",
                    )  # fmt: skip
                    points = None
                yield points

    def _points(self, given: Any, route: Route, least: int, single: bool = False) -> Array | None:
        """Points as (n, 2), without their heights."""
        held = self._list(given, route)
        for n, point in enumerate(held):
            numbers = (
                isinstance(point, list)
                and len(point) >= 2
                and all(_number(value) is not None for value in point[:2])
            )
            if not numbers:
                at = route if single else (*route, n)
                self.refuse(
                    at, f"{quoted(str(point)[:40])} is no point", "write [longitude, latitude]"
                )
                return None
        if len(held) < least:
            if isinstance(given, list):
                self.refuse(route, f"{len(held)} points are too few", f"write at least {least}")
            return None
        if any(len(point) > 2 for point in held):
            self.leave_out("heights of points")
        return np.array([point[:2] for point in held], dtype=float)

    def _list(self, given: Any, route: Route) -> list[Any]:
        if isinstance(given, list):
            return given
        self.refuse(route, "a list belongs here", "see RFC 7946")
        return []

    def leave_out(self, why: str) -> None:
        """Count what no world can hold."""
        self.left_out[why] = self.left_out.get(why, 0) + 1

    def refuse(self, route: Route, wrong: str, right: str) -> None:
        """Note a mistake at its place."""
        place = place_of(self.head.raw, self.head.shown, route)
        self.mistakes.append(Mistake(place, field_of(route), wrong, right))


def _number(value: Any) -> float | None:
    """A finite number, None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if math.isfinite(value) else None


def _is_name(value: Any) -> bool:
    return (isinstance(value, str) and bool(value.strip())) or (
        isinstance(value, int) and not isinstance(value, bool)
    )


def _id(about: dict[str, Any]) -> int | None:
    """The whole number that a point goes by, None where it has none."""
    for key in IDS:
        text = str(about.get(key, "")).strip()
        if text.isdecimal() and len(text) < 10:
            return int(text)
    return None
