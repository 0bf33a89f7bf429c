"""SVG: paths, rectangles, circles, polygons and lines, with all their transforms."""

from collections import Counter
from collections.abc import Iterator
from functools import reduce
from io import BytesIO
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from ekfsim.errors import UsageError
from ekfsim.files.maps.drawn.curves import WITHIN, flat
from ekfsim.files.maps.drawn.drawing import Drawing
from ekfsim.files.maps.plan import METRES, Asked, Plan
from ekfsim.files.maps.reading import Head
from ekfsim.geometry import Array

SAME = 1e-9  # of a path's own unit: ends that meet, radii that are one


def read(head: Head, asked: Asked) -> Plan:
    """The plan of an SVG file: closed shapes are obstacles, open ones walls; y counts upwards from
    the picture's lower edge.

    Raises UsageError where svgelements is missing, where the file is no SVG, or where nothing says
    what its unit is.
    """
    if asked.units is None or asked.units == "degrees":
        raise UsageError(
            f"{head.shown}: a picture does not say how large it is; say what one of its units "
            "(those of its viewBox) is: --units m, cm, mm, in or ft"
        )
    picture = _picture(head)
    placed = _Placed(picture, METRES[asked.units])
    tolerance = asked.tolerance or WITHIN
    drawing = Drawing(told=[f"one unit of the picture is {placed.scale:g} m, its lower edge y = 0"])
    left_out, curved = Counter[str](), False
    for number, (kind, shape) in enumerate(_shapes(picture, left_out), 1):
        name = str(getattr(shape, "id", None) or f"{kind} {number}")
        if (circle := placed.circle(shape)) is not None:
            drawing.circle(name, *circle)
            continue
        closed, opened, bends = placed.parts(shape, tolerance)
        curved |= bends
        for outer, holes in _nested(closed):
            drawing.outline(name, outer, holes)
        for line in opened:
            drawing.line(name, line)
    if curved:
        drawing.told.append(f"curves became straight lines within {tolerance:g} m (--tolerance)")
    drawing.told += [f"{count} of {kind}: left out" for kind, count in left_out.items()]
    return drawing.plan(head.path.stem, asked)


def _picture(head: Head) -> Any:
    """What the file draws, transforms applied."""
    try:
        from svgelements import SVG
    except ImportError:
        raise UsageError(
            "SVG needs the package 'svgelements': pip install 'ekfsim[maps]'"
        ) from None
    from xml.etree.ElementTree import ParseError

    try:
        return SVG.parse(BytesIO(head.raw), reify=False)
    except (ParseError, ValueError, TypeError, AttributeError, RecursionError) as error:
        why = str(error).split("\n")[0]
        raise UsageError(f"{head.shown}: this is no SVG that can be read: {why}") from None


def _shapes(picture: Any, left_out: Counter[str]) -> Iterator[tuple[str, Any]]:
    """The shapes that are seen, with their kinds."""
    from svgelements import Image, Shape, Text

    for element in picture.elements():
        if isinstance(element, Text | Image):
            left_out[type(element).__name__.lower()] += 1
        elif isinstance(element, Shape):
            kind = str(element.values.get("tag", "path"))
            if element.values.get("visibility") == "hidden":
                left_out[f"hidden {kind}"] += 1
            else:
                yield kind, element


class _Placed:
    """How a picture lies in the world."""

    def __init__(self, picture: Any, scale: float) -> None:
        from svgelements import Matrix

        self.scale = scale
        self.back = ~Matrix(picture.viewbox_transform or "")  # pixels → the viewBox's own units
        box = picture.viewbox
        self.left = float(box.x or 0) if box is not None else 0.0
        height = float(box.height) if box is not None and box.height is not None else None
        top = float(box.y or 0) if box is not None else 0.0
        self.bottom = top + (float(picture.height or 0) if height is None else height)

    def points(self, drawn: list[Any]) -> Array:
        """Pixels → m : (n, 2)"""
        own = [self.back.point_in_matrix_space(point) for point in drawn]
        return self.scale * np.array([(p.x - self.left, self.bottom - p.y) for p in own])

    def circle(self, shape: Any) -> tuple[float, float, float] | None:
        """The middle and the radius of a circle, m; None of any other shape."""
        from svgelements import Circle, Ellipse

        if not isinstance(shape, Circle | Ellipse):
            return None
        rx, ry = float(shape.implicit_rx), float(shape.implicit_ry)
        if abs(rx - ry) > SAME * max(rx, ry):
            return None
        center = shape.implicit_center
        middle, rim = self.points([center, (center.x + rx, center.y)])
        x, y = middle.tolist()
        return x, y, float(np.hypot(*(rim - middle)))

    def parts(self, shape: Any, tolerance: float) -> tuple[list[Array], list[Array], bool]:
        """Closed outlines, open lines, and whether any of it is curved."""
        from svgelements import Close, Line, Move, Path

        closed, opened, bends = list[Array](), list[Array](), False
        for subpath in abs(Path(shape)).as_subpaths():
            corners, ends = list[Array](), False
            for segment in subpath:
                if isinstance(segment, Move):
                    corners.append(self.points([segment.end]))
                elif isinstance(segment, Line | Close):
                    ends |= isinstance(segment, Close)
                    if segment.end is not None:
                        corners.append(self.points([segment.end]))
                elif segment.start is not None:
                    bends = True
                    corners.append(flat(self._along(segment), tolerance))
            if not corners:
                continue
            points = np.vstack(corners)
            meets = len(points) > 3 and np.hypot(*(points[0] - points[-1])) <= SAME * self.scale
            if meets:
                points = points[:-1]
            (closed if ends or meets else opened).append(points)
        return closed, opened, bends

    def _along(self, segment: Any) -> Any:
        def at(t: float) -> tuple[float, float]:
            x, y = self.points([segment.point(t)])[0].tolist()
            return x, y

        return at


def _nested(closed: list[Array]) -> Iterator[tuple[Array, list[Array]]]:
    """The outlines of one path with the holes that its other outlines are, by the even-odd rule."""
    rings: list[BaseGeometry] = [shapely.Polygon(one) for one in closed if len(one) > 2]
    if len(rings) < 2 or not all(ring.is_valid for ring in rings):
        yield from ((points, []) for points in closed)
        return
    shape = reduce(lambda one, other: one.symmetric_difference(other), rings)
    for part in shapely.get_parts(shape):
        if isinstance(part, shapely.Polygon):
            yield (
                shapely.get_coordinates(part.exterior),
                [shapely.get_coordinates(hole) for hole in part.interiors],
            )
