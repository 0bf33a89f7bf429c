"""The cells of a map → what stands in the room that a robot is in."""

import math

import numpy as np
import shapely
from scipy import ndimage

from ekfsim.errors import UsageError
from ekfsim.files.maps.pixels.cells import Reading
from ekfsim.files.maps.pixels.image import Grey
from ekfsim.files.maps.pixels.straight import corners, farthest, straightened
from ekfsim.files.maps.pixels.tracing import outlines, without_corners
from ekfsim.files.maps.plan import Asked, Outline, Plan, Scan, Start
from ekfsim.geometry import Array, Booleans, Integers

CELLS = 2.0  # the tolerance, in cells, where nobody says another
SHARE = 0.05  # and no more of the picture's shorter side than this: few cells are no stairs
NAMED = 3  # other free places whose whereabouts are told
LARGE = 0.02  # of the room: a place that is worth naming
NOT_SEEN = 205 / 255  # how bright map savers draw what nobody has seen


def plan_of(
    name: str,
    grey: Grey,
    reading: Reading,
    resolution: float,
    origin: Start,
    asked: Asked,
    told: list[str],
    shown: str,
) -> Plan:
    """The plan of a picture. resolution : m, a cell's side; origin : of its lower left corner

    Where unknown cells are walls, it is the room that the start lies in, or else the largest.
    """
    occupied, free = (cells[::-1] for cells in reading.cells(grey))  # row 0 at the bottom
    told += _grey_that_is_free(grey, free[::-1], reading)
    lying = _Lying(resolution, origin)
    tolerance = min(CELLS, SHARE * min(free.shape))
    if asked.tolerance is not None:
        tolerance = asked.tolerance / resolution
    unseen = _unseen(grey, reading)[::-1]
    if asked.unknown == "free":
        seen = _room(without_corners(free), unseen, lying, asked, [], shown)
        indoors = _largest(seen)
        room, stepped = None, outlines(~without_corners(~occupied))
    else:
        free = without_corners(free | _slits(occupied, free, tolerance, told))
        inside = _room(free, unseen, lying, asked, told, shown)
        room, *holes = sorted(outlines(inside), key=_area, reverse=True)
        indoors = _largest(inside & ~unseen) if (inside & unseen).any() else None
        stepped = [hole[::-1] for hole in holes]
    large = [ring for ring in stepped if np.ptp(ring, axis=0).max() >= tolerance]
    rings = large if room is None else [room, *large]
    straight = straightened(rings, tolerance)
    told += _straightened(rings, straight, len(stepped) - len(large), tolerance, resolution)
    boundary = None if room is None else lying.placed(straight.pop(0))
    things = _things(large, straight, lying)
    return Plan(
        name, boundary, things, told=tuple(told), scan=lying.scan(grey),
        indoors=None if indoors is None else lying.placed(corners(indoors)),
    )  # fmt: skip


class _Lying:
    """How the cells lie in the world."""

    def __init__(self, resolution: float, origin: Start) -> None:
        self.resolution, self.origin = resolution, origin
        yaw = math.radians(origin[2])
        self.turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])

    def placed(self, points: Array) -> Array:
        """Cells (…, 2), counted from the lower left corner, → m."""
        turned = np.matvec(self.turn, self.resolution * points)
        return np.asarray(np.array(self.origin[:2]) + turned)

    def cell(self, place: Start) -> tuple[int, int]:
        """The row from the bottom and the column in which a place lies."""
        away = np.array(place[:2]) - np.array(self.origin[:2])
        column, row = np.floor(np.matvec(self.turn.T, away) / self.resolution).tolist()
        return int(row), int(column)

    def scan(self, grey: Grey) -> Scan:
        """The picture, as it is drawn below the walls."""
        return Scan(grey.bright, self.resolution, self.origin)


def _room(
    free: Booleans, unseen: Booleans, lying: _Lying, asked: Asked, told: list[str], shown: str
) -> Booleans:
    """The cells of the room that is wanted, or else of the one of which most was seen.
    Raises UsageError where there is none.
    """
    rooms, number = ndimage.label(free)
    if not number:
        raise UsageError(f"{shown}: no cell of this map is free")
    sizes = np.bincount(rooms.ravel())[1:]
    seen = np.bincount(rooms[~unseen], minlength=number + 1)[1:]
    wanted = int(np.lexsort([sizes, seen])[-1]) + 1
    if asked.start is not None:
        row, column = lying.cell(asked.start)
        inside = 0 <= row < free.shape[0] and 0 <= column < free.shape[1]
        if not inside or not (wanted := int(rooms[row, column])):
            x, y, _ = asked.start
            raise UsageError(f"--start: ({x:g}, {y:g}) is not free in {shown}")
    if others := int(sizes.sum() - sizes[wanted - 1]):
        area = others * lying.resolution**2
        places = "place" if number == 2 else "places"
        told.append(
            f"{number - 1} other free {places}, {area:.3g} m² together, cannot be reached from "
            f"this room, and are left out; --start in one of them takes that"
            f"{_where(rooms.astype(np.int64), sizes, wanted, lying)}"
        )
    return np.asarray(rooms == wanted)


def _where(rooms: Integers, sizes: Integers, wanted: int, lying: _Lying) -> str:
    """The largest of the places that are not wanted, as the end of a sentence, each by a point
    within it; those that are small beside the room are not worth naming.
    """
    boxes, named = ndimage.find_objects(rooms), []
    for room in (np.argsort(-sizes)[: NAMED + 1] + 1).tolist():
        if room == wanted or sizes[room - 1] < LARGE * sizes[wanted - 1]:
            continue
        rows, columns = boxes[room - 1]
        deep = ndimage.distance_transform_edt(np.pad(rooms[rows, columns] == room, 1))
        row, column = np.array(np.unravel_index(np.argmax(deep), deep.shape)) - 1
        x, y = lying.placed(np.array([columns.start + column, rows.start + row]) + 0.5).tolist()
        area = sizes[room - 1] * lying.resolution**2
        named.append(f"{area:.3g} m² about ({x:.4g}, {y:.4g})")
    return f": {', '.join(named[:NAMED])}" if named else ""


def _slits(occupied: Booleans, free: Booleans, tolerance: float, told: list[str]) -> Booleans:
    """The unknown cells among free ones that border on nothing occupied, no wider together than the
    tolerance: where beams passed on either side, and met nothing.
    """
    unknown = ~(occupied | free)
    places, number = ndimage.label(unknown)
    side = int(tolerance) + 1
    wide = ndimage.binary_erosion(unknown, np.ones((side, side), bool))
    beside = ndimage.binary_dilation(occupied, np.ones((3, 3), bool))
    edge = np.ones_like(free)
    edge[1:-1, 1:-1] = False
    kept = np.zeros(number + 1, bool)
    kept[places[wide | beside | edge]] = True
    kept[0] = True
    if count := int(np.count_nonzero(~kept)):
        slits = "slit" if count == 1 else "slits"
        told.append(
            f"{count} {slits} of unknown cells among free ones, beside nothing occupied, "
            f"{'is' if count == 1 else 'are'} free"
        )
    return np.asarray(~kept[places])


def _things(rings: list[Array], straight: list[Array], lying: _Lying) -> tuple[Outline, ...]:
    """What takes up room: outlines, counter-clockwise, with the holes in them, clockwise; straight,
    but where a hole would not lie in its outline then.
    """
    shapes = [shapely.Polygon(ring) for ring in rings]
    solid = [k for k, ring in enumerate(rings) if _area(ring) > 0]
    tree = shapely.STRtree([shapes[k] for k in solid])
    holes: dict[int, list[int]] = {k: [] for k in solid}
    for k, ring in enumerate(rings):
        if _area(ring) < 0:
            around = [solid[n] for n in tree.query(shapes[k], predicate="covered_by").tolist()]
            holes[min(around, key=lambda n: shapes[n].area)].append(k)
    found = []
    for number, k in enumerate(solid, 1):
        own, inside = straight[k], [straight[hole] for hole in holes[k]]
        if not shapely.Polygon(own, inside).is_valid:
            own, inside = corners(rings[k]), [corners(rings[hole]) for hole in holes[k]]
        placed = tuple(lying.placed(hole) for hole in inside)
        found.append(Outline(f"thing {number}", lying.placed(own), placed))
    return tuple(found)


def _straightened(
    rings: list[Array], straight: list[Array], specks: int, tolerance: float, side: float
) -> list[str]:
    """What is to be said of walls that were made straight, and of what was left out."""
    worst = round(max(map(farthest, rings, straight), default=0.0) * side, 4)
    lines = [
        f"walls are straight within {tolerance * side:g} m of the cells, {worst:.2g} m from them "
        "at most; --tolerance says otherwise"
    ]
    if specks:
        things = "thing was" if specks == 1 else "things were"
        lines.append(f"{specks} {things} left out, smaller than that")
    return lines


def _largest(free: Booleans) -> Array | None:
    """The outline of the largest place of free cells; None where there is none."""
    return max(outlines(without_corners(free)), key=_area, default=None)


def _area(ring: Array) -> float:
    """The area within an outline, negative where that runs clockwise."""
    (x, y), (u, v) = ring.T, np.roll(ring, -1, axis=0).T
    return float((x * v - u * y).sum() / 2)


def _grey_that_is_free(grey: Grey, free: Booleans, reading: Reading) -> list[str]:
    """What is to be said where pixels are free that map savers draw so for unknown."""
    pixels = int(np.count_nonzero(free & _unseen(grey, reading)))
    if not pixels:
        return []
    return [
        f"{pixels} {'pixel' if pixels == 1 else 'pixels'} of grey 205, by which map savers mean "
        f"unknown, are free by free_thresh {reading.free:g}; write free_thresh: 0.196 in the map "
        "where they are not"
    ]


def _unseen(grey: Grey, reading: Reading) -> Booleans:
    """Which pixels have the grey by which map savers mean unknown."""
    if reading.mode == "raw" or reading.negate:
        return np.zeros(grey.bright.shape, bool)
    return np.asarray(np.abs(grey.bright - NOT_SEEN) < 1e-9)
