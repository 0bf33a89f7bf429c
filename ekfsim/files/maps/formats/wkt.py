"""WKT: a geometry a line, or over several lines until its brackets are closed."""

import re
from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.maps.drawn.drawing import Drawing
from ekfsim.files.maps.drawn.units import TINY, places
from ekfsim.files.maps.plan import Asked, Plan, Units
from ekfsim.files.maps.reading import Head
from ekfsim.files.source import mistake
from ekfsim.geometry import Array
from ekfsim.printable import quoted

SRID = re.compile(r"\s*SRID\s*=\s*(\d+)\s*;", re.IGNORECASE)
OF_THE_EARTH = 4326  # WGS 84, longitude and latitude


def read(head: Head, asked: Asked) -> Plan:
    """The plan of a WKT file: polygons are obstacles, lines are walls.

    Raises InputError with all geometries that are none, UsageError where the coordinates cannot be
    in their units.
    """
    shapes, mistakes, systems = list[BaseGeometry](), list[Mistake](), set[int]()
    for line, text in _texts(head):
        if (marked := SRID.match(text)) is not None:
            systems.add(int(marked[1]))
            text = text[marked.end() :]
        try:
            shapes.append(shapely.from_wkt(text))
        except (shapely.errors.GEOSException, NotImplementedError) as error:
            wrong = str(error).split("Exception: ")[-1].rstrip(". ")
            why = f"{quoted(text.strip()[:40])} is no geometry: {wrong}"
            mistakes.append(
                Mistake(Place(head.shown, line, 1), "", why, "write POLYGON ((0 0, …))")
            )
    if mistakes:
        raise InputError(mistakes[:20])
    told = list[str]()
    units: Units = asked.units or ("degrees" if systems == {OF_THE_EARTH} else "m")
    points = shapely.get_coordinates(shapes)
    if asked.units is None and units == "m":
        across = float(np.ptp(points, axis=0).max()) if len(points) else 1.0
        if across < TINY:
            raise UsageError(
                f"{head.shown}: read as metres the plan is {across:.3g} m across; --units degrees "
                "says that these are longitude and latitude"
            )
        told.append("one of its coordinates is taken for a metre (otherwise: --units degrees)")
    if any(shapely.has_z(shapes)):
        told.append("heights of points: left out")
    drawing = Drawing(told=told)
    place = places(points, units, head.shown, told)
    for n, shape in enumerate(shapes, 1):
        for part in _parts(shape):
            name = f"{part.geom_type.lower()} {n}"
            if part.is_empty:
                drawing.leave_out("is empty", name)
            elif isinstance(part, shapely.Polygon):
                rings = [part.exterior, *part.interiors]
                outer, *holes = (place(_flat(ring)) for ring in rings)
                drawing.outline(name, outer, holes)
            elif part.geom_type == "Point":
                drawing.leave_out("is a point without an id", name)
            else:
                drawing.line(name, place(_flat(part)))
    return drawing.plan(head.path.stem, asked)


def _texts(head: Head) -> Iterator[tuple[int, str]]:
    """Each geometry's text and the number of its first line."""
    try:
        lines = head.raw.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        wrong = f"the byte 0x{head.raw[error.start]:02x} is not UTF-8"
        raise mistake(head.shown, 1, 1, wrong, "WKT is plain text") from None
    held, first = "", 0
    for number, line in enumerate(lines, 1):
        if not held and (not line.strip() or line.lstrip().startswith("#")):
            continue
        first = first if held else number
        held += f" {line.strip().removesuffix(';')}"
        if held.count("(") == held.count(")"):
            yield first, held.strip()
            held = ""
    if held:
        yield first, held.strip()


def _parts(shape: BaseGeometry) -> Iterator[BaseGeometry]:
    """The polygons, lines and points of a geometry."""
    if shape.geom_type.startswith("Multi") or shape.geom_type == "GeometryCollection":
        for part in shapely.get_parts(shape):
            yield from _parts(part)
    else:
        yield shape


def _flat(line: BaseGeometry) -> Array:
    return np.asarray(shapely.get_coordinates(line))
