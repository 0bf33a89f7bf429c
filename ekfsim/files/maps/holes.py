"""An outline with holes → outlines without, which cover the same: a world's obstacles have none.

Nothing is cut open by a slit and no wall is parted: the cuts run from corner to corner, inside of
what takes up room, where no beam comes from.
"""

from collections import defaultdict
from collections.abc import Iterator

import numpy as np
import shapely

from ekfsim.files.maps.plan import Outline
from ekfsim.geometry import Array

Corner = tuple[float, float]
Edge = tuple[Corner, Corner]


def without_holes(outline: Outline) -> Iterator[Outline]:
    """The same outline, or its parts where it has holes."""
    if not outline.holes:
        yield outline
        return
    shape = shapely.Polygon(outline.points, outline.holes)
    triangles = [
        tuple(map(tuple, shapely.get_coordinates(triangle)[:3].tolist()))
        for triangle in shapely.get_parts(shapely.constrained_delaunay_triangles(shape))
    ]
    for number, part in enumerate(_parts(triangles)):
        name = outline.name if not number else f"{outline.name} part {number + 1}"
        yield Outline(name, part)


def _parts(triangles: list[tuple[Corner, ...]]) -> Iterator[Array]:
    """Triangles joined to outlines (n, 2) that touch themselves nowhere."""
    at = defaultdict[frozenset[Corner], list[int]](list)
    for number, corners in enumerate(triangles):
        for edge in _edges(corners):
            at[frozenset(edge)].append(number)
    left = dict.fromkeys(range(len(triangles)))
    while left:
        first = next(iter(left))
        del left[first]
        rim = dict(_edges(triangles[first]))  # the outline so far, from corner to corner
        near = list(_edges(triangles[first]))
        while near:
            edge = near.pop()
            for number in at[frozenset(edge)]:
                if number in left and _grow(rim, triangles[number]):
                    del left[number]
                    near += _edges(triangles[number])
        yield _ring(rim)


def _grow(rim: dict[Corner, Corner], corners: tuple[Corner, ...]) -> bool:
    """Whether a triangle beside an outline could be joined to it without its touching itself."""
    edges = _edges(corners)
    shared = [(a, b) for a, b in edges if rim.get(b) == a]
    own = [edge for edge in edges if edge not in shared]
    if len(shared) == 1 and own[0][1] in rim:
        return False  # its third corner is the outline's already
    if not shared or len(shared) == 3:
        return False
    for _, b in shared:
        del rim[b]
    rim.update(own)
    return True


def _edges(corners: tuple[Corner, ...]) -> list[Edge]:
    """The edges of a triangle, counter-clockwise, beginning with any."""
    a, b, c = corners
    if (b[0] - a[0]) * (c[1] - a[1]) < (c[0] - a[0]) * (b[1] - a[1]):
        b, c = c, b
    return [(a, b), (b, c), (c, a)]


def _ring(rim: dict[Corner, Corner]) -> Array:
    """The corners of an outline in order, (n, 2)."""
    first = place = next(iter(rim))
    ring = [first]
    while (place := rim[place]) != first:
        ring.append(place)
    return np.array(ring)
