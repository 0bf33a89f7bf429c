"""Where a robot can start among the walls of a plan: where it has most room."""

import math

import numpy as np
import shapely

from ekfsim.files.maps.plan import Plan, Start

HAIR = 1e-6  # m, the thickness of what has none


def roomiest(plan: Plan) -> tuple[Start, float] | None:
    """The place with most room about it, looking along +x; and how much that is, m. None where a
    robot can stand nowhere.
    """
    taken = [
        *(shapely.Polygon(one.points, one.holes) for one in plan.outlines),
        *(shapely.LineString(one.points).buffer(HAIR) for one in plan.lines),
        *(shapely.Point(one.x, one.y).buffer(one.radius) for one in plan.circles),
    ]
    if (around := plan.boundary if plan.indoors is None else plan.indoors) is not None:
        room = shapely.Polygon(around)
    else:
        room = shapely.box(*shapely.union_all(taken).bounds) if taken else shapely.box(0, 0, 2, 2)
    free = room.difference(shapely.union_all(list(map(shapely.make_valid, taken))))
    if free.is_empty or free.area == 0:
        return None
    radius = shapely.maximum_inscribed_circle(
        shapely.MultiPolygon([part for part in shapely.get_parts(free) if part.area > 0]),
        tolerance=0.01 * math.sqrt(free.area),
    )
    digits = 1 - math.floor(math.log10(max(radius.length, 1e-9)))  # two of how much room there is
    x, y = np.round(shapely.get_coordinates(radius)[0], digits).tolist()
    return (x, y, 0.0), float(free.boundary.distance(shapely.Point(x, y)))
