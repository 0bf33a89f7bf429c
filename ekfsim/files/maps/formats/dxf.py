"""DXF: lines, polylines, circles and arcs of the model space, blocks where they are inserted."""

import math
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.maps.drawn.curves import WITHIN
from ekfsim.files.maps.drawn.drawing import Drawing
from ekfsim.files.maps.plan import METRES, Asked, Plan
from ekfsim.files.maps.reading import Head
from ekfsim.geometry import Array
from ekfsim.printable import quoted

DRAWN = ("LINE", "LWPOLYLINE", "POLYLINE", "CIRCLE", "ARC", "ELLIPSE", "SPLINE")
ROUND = ("CIRCLE", "ARC", "ELLIPSE", "SPLINE")
SAME = 1e-9  # of the drawing's unit: ends that meet


def read(head: Head, asked: Asked) -> Plan:
    """The plan of a DXF file: closed outlines are obstacles, all other lines are walls. A wall goes
    by its layer.

    Raises UsageError where ezdxf is missing, where the file is no DXF, or where neither it nor the
    user says what its unit is.
    """
    document = _document(head)
    scale, told = _scale(document, head.shown, asked)
    tolerance = asked.tolerance or WITHIN
    drawing = Drawing(told=told)
    left_out, curved, high = Counter[str](), False, False
    for entity in _entities(document, left_out):
        name = f"{entity.dxf.layer} {entity.dxftype().lower()}"
        if entity.dxftype() == "CIRCLE":
            x, y, _ = entity.ocs().to_wcs(entity.dxf.center)
            drawing.circle(name, x * scale, y * scale, entity.dxf.radius * scale)
            continue
        points = _points(entity, tolerance / scale)
        curved |= entity.dxftype() in ROUND or bool(getattr(entity, "has_arc", False))
        high |= bool(len(points)) and bool(np.ptp(points[:, 2]) > SAME)
        flat = points[:, :2] * scale
        closed = len(flat) > 3 and math.dist(points[0], points[-1]) <= SAME
        if closed:
            drawing.outline(name, flat[:-1])
        else:
            drawing.line(name, flat)
    if curved:
        told.append(f"curves became straight lines within {tolerance:g} m (--tolerance)")
    if high:
        told.append("heights of points: left out")
    told += [f"{count} of {kind}: left out" for kind, count in left_out.items()]
    return drawing.plan(head.path.stem, asked)


def _document(head: Head) -> Any:
    """The drawing that a file holds."""
    try:
        import ezdxf
    except ImportError:
        raise UsageError("DXF needs the package 'ezdxf': pip install 'ekfsim[maps]'") from None
    try:
        return ezdxf.readfile(head.path)  # type: ignore[attr-defined]
    except (ezdxf.DXFError, OSError, UnicodeDecodeError) as error:  # type: ignore[attr-defined]
        why = str(error).strip().split("\n")[0]
        raise UsageError(f"{head.shown}: this is no DXF that can be read: {why}") from None


def _scale(document: Any, shown: str, asked: Asked) -> tuple[float, list[str]]:
    """The metres of the drawing's unit, and what is told of it."""
    from ezdxf.enums import InsertUnits
    from ezdxf.units import conversion_factor

    if asked.units == "degrees":
        raise UsageError(f"{shown}: a DXF is not in degrees; say --units m, cm, mm, in or ft")
    if asked.units is not None:
        return METRES[asked.units], []
    try:
        if document.units == 0:
            raise ValueError
        scale = float(conversion_factor(InsertUnits(document.units), InsertUnits.Meters))
    except (ValueError, KeyError, IndexError, TypeError):
        raise UsageError(
            f"{shown}: the file does not say what its unit is ($INSUNITS is {document.units}); say "
            "--units m, cm, mm, in or ft"
        ) from None
    return scale, [f"one unit of the drawing is {scale:g} m ($INSUNITS; otherwise: --units)"]


def _entities(document: Any, left_out: Counter[str]) -> Iterator[Any]:
    """What is drawn on layers that are seen, that of blocks where each is inserted."""
    from ezdxf.disassemble import recursive_decompose

    hidden = {
        layer.dxf.name.lower() for layer in document.layers if layer.is_off() or layer.is_frozen()
    }
    kept = []
    for entity in document.modelspace():
        if entity.dxftype() in (*DRAWN, "INSERT"):
            kept.append(entity)
        else:
            left_out[entity.dxftype()] += 1
    for entity in recursive_decompose(kept):
        if entity.dxf.get("layer", "0").lower() in hidden:
            left_out[f"the hidden layer {quoted(entity.dxf.layer)}"] += 1
        elif entity.dxftype() in DRAWN:
            yield entity
        else:
            left_out[entity.dxftype()] += 1


def _points(entity: Any, tolerance: float) -> Array:
    """The corners of an entity in the world, (n, 3), arcs and bulges in straight pieces."""
    kind = entity.dxftype()
    if kind == "LINE":
        points = [entity.dxf.start, entity.dxf.end]
    elif kind in ("ARC", "ELLIPSE", "SPLINE"):
        points = list(entity.flattening(tolerance))
    else:
        points = _chained(entity, tolerance)
    return np.array([tuple(point) for point in points], dtype=float).reshape(-1, 3)


def _chained(entity: Any, tolerance: float) -> list[Any]:
    """The corners of a polyline; its bulges are arcs, which run counter-clockwise each."""
    light = entity.dxftype() == "LWPOLYLINE"
    corners = list(entity.vertices_in_wcs() if light else entity.points_in_wcs())
    if not entity.has_arc:
        closed = bool(entity.is_closed) and len(corners) > 2
        return [*corners, *corners[:1]] if closed else corners
    points = corners[:1]
    for piece in entity.virtual_entities():
        part = list(
            piece.flattening(tolerance)
            if piece.dxftype() == "ARC"
            else (piece.dxf.start, piece.dxf.end)
        )
        if points[-1].distance(part[0]) > points[-1].distance(part[-1]):
            part.reverse()
        points += part[1:]
    return points
