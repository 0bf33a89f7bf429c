"""Obstacles' names and landmarks' numbers, lightly: inside or beside what they name, where they lie
on nothing that moves. A name that finds no such place in a view is left out of it.
"""

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
import shapely
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from shapely.geometry.base import BaseGeometry

from ekfsim.geometry import Array, Booleans
from ekfsim.views.picture.artists import empty
from ekfsim.views.picture.written.crossed import Crossed
from ekfsim.views.picture.written.lettering import drawable, shortened
from ekfsim.views.picture.written.outlined import PER_POINT, lettered
from ekfsim.world import World

POINTS, SMALLER = 7.0, 6.5  # the letters' size of names and of numbers
HEIGHT, DROP = 1.05, 0.36  # of a line, and from its middle to its baseline, in letters' sizes
MOST = 60  # names in one picture; the largest obstacles come first
MOST_NUMBERS = 200  # of landmarks
GAP = 3.0  # pixels between a name and what stands beside it
CLEAR = 4.0  # pixels between a name and what moves
ALONG = (0.5, 0.1, 0.9)  # of a side: where a name may stand beside it
APART = np.full((1, 2), np.nan)  # between two lines
MARK = 9.0  # pixels that a landmark's triangle is wide and high


class Name(NamedTuple):
    """One of them, as it stands in the picture. In pixels."""

    text: str
    points: float  # of its letters
    center: Array  # (2,)
    size: Array  # (2,)

    @property
    def box(self) -> Array:
        """Left, bottom, right, top : (4,)"""
        return np.concatenate([self.center - self.size / 2, self.center + self.size / 2])


class Names:
    """All that a map names, as one artist."""

    def __init__(self, axes: Axes, world: World) -> None:
        self._axes, self._world = axes, world
        figure = axes.get_figure(root=True)
        assert figure is not None
        self._figure = figure
        self.artist = PathPatch(
            Path(np.empty((0, 2))), transform=figure.dpi_scale_trans, facecolor="#333333",
            linewidth=0, gid="names", zorder=1.5,
        )  # fmt: skip
        axes.add_patch(self.artist)
        self._arranged_for: object = None
        self._places: list[Name] = []  # of one name all that are thinkable, the best first
        self._which = np.empty(0, int)  # the name that each of them is of
        self._boxes = np.empty((0, 4))
        self._blocked: bytes | None = None
        self.shown: list[Name] = []

    def show(self, moving: Iterable[Artist]) -> None:
        """Put each where none of these artists is drawn, nor another name."""
        now = (*self._axes.viewLim.extents, *self._axes.bbox.extents, self._figure.dpi)
        if now != self._arranged_for:
            self._arranged_for, self._blocked = now, None
            self._arrange()
        if not self._places:
            return
        blocked = self._on_what_moves(moving)
        if blocked.tobytes() != self._blocked:
            self._blocked = blocked.tobytes()
            chosen = list(self._chosen(blocked))
            if [*map(id, chosen)] != [*map(id, self.shown)]:
                self.shown = chosen
                self.artist.set_path(self._letters())

    def _arrange(self) -> None:
        """Find the places where a name covers nothing that stands still."""
        self._axes.apply_aspect()
        self._places, which = [], []
        for number, places in enumerate(self._thinkable()):
            self._places += places
            which += [number] * len(places)
        self._which = np.array(which, int)
        self._boxes = np.array([place.box for place in self._places]).reshape(-1, 4)
        if not self._places and self.shown:
            self.shown = []
            self.artist.set_path(self._letters())

    def _thinkable(self) -> Iterator[list[Name]]:
        """Of each name all places where it would do, the best first."""
        floor, to_pixels = self._world.map, self._axes.transData.transform
        window = shapely.box(*self._axes.bbox.extents)
        areas = (shapely.Polygon(to_pixels(obstacle.outline)) for obstacle in floor.obstacles)
        shapes = [shapely.make_valid(area) for area in areas]
        spots = [to_pixels((mark.x, mark.y)) for mark in self._world.landmarks]
        marks = [_box(spot, np.full(2, MARK)) for spot in spots]
        walls = [] if floor.boundary is None else [shapely.LinearRing(to_pixels(floor.boundary))]
        lines = [shapely.LineString(to_pixels(line.points)) for line in floor.lines]
        taken = shapely.STRtree([*shapes, *marks, *walls, *lines])
        room = None if floor.boundary is None else shapely.Polygon(to_pixels(floor.boundary))

        def beside(shape: BaseGeometry, size: Array) -> list[Array]:
            """Where nothing ever drives first."""
            places = list(_beside(shape, taken, window, size))
            return sorted(places, key=lambda at: room is not None and room.contains(_box(at, size)))

        for i in np.argsort([-shape.area for shape in shapes], kind="stable")[:MOST]:
            text = drawable(shortened(floor.obstacles[i].name, 20))
            size = self._size(text, POINTS)
            places = [
                *_inside(shapes[i], taken, int(i), size),
                *beside(shapes[i], size),
            ]
            yield [Name(text, POINTS, place, size) for place in places]
        for line in list(floor.named_lines())[:MOST]:
            text = drawable(shortened(line.name, 20))
            size, wall = self._size(text, POINTS), shapely.LineString(to_pixels(line.points))
            yield [Name(text, POINTS, place, size) for place in beside(wall, size)]
        for mark, shape in zip(self._world.landmarks, marks, strict=True):
            if len(marks) <= MOST_NUMBERS:
                text = str(mark.id)
                size = self._size(text, SMALLER)
                yield [Name(text, SMALLER, place, size) for place in beside(shape, size)]

    def _size(self, text: str, points: float) -> Array:
        """Width and height of a name : (2,) pixels"""
        _, width = lettered(text)
        inches = points * np.array([width * PER_POINT, HEIGHT / 72])
        return inches * self._figure.dpi

    def _on_what_moves(self, moving: Iterable[Artist]) -> Booleans:
        """Which places are not free : (n,)"""
        crossed = Crossed(self._axes.bbox.extents)
        grown = self._boxes + CLEAR * np.array([-1, -1, 1, 1])
        lines, areas, end = [APART], [], 1
        for artist in moving:
            for points, is_area in _drawn(artist):
                lines += [points, points[-1:], APART]  # a single point becomes a line, too
                if is_area:
                    areas.append(slice(end, end + len(points)))
                end += len(points) + 2
        pixels = self._axes.transData.transform(np.concatenate(lines))
        crossed.add(pixels)
        blocked = crossed.inside(grown)
        for area in areas:
            _block(blocked, grown, pixels[area])
        return blocked

    def _chosen(self, blocked: Any) -> Iterator[Name]:
        """The first free place of each name that lies on no other name."""
        boxes = np.empty((0, 4))
        done = -1
        for i in np.flatnonzero(~blocked):
            if self._which[i] == done:
                continue
            box = self._boxes[i]
            apart = (
                (boxes[:, 2] + GAP < box[0])
                | (boxes[:, 0] - GAP > box[2])
                | (boxes[:, 3] < box[1])
                | (boxes[:, 1] > box[3])
            )
            if apart.all():
                boxes, done = np.vstack([boxes, box]), self._which[i]
                yield self._places[i]

    def _letters(self) -> Path:
        """The outlines of all names that are shown, in inches."""
        vertices, codes = [np.empty((0, 2))], [np.empty(0, np.uint8)]
        for name in self.shown:
            (points, kinds), width = lettered(name.text)
            start = name.center / self._figure.dpi
            start = start - name.points * np.array([width * PER_POINT / 2, DROP / 72])
            vertices.append(points * name.points * PER_POINT + start)
            codes.append(kinds)
        return Path(np.concatenate(vertices), np.concatenate(codes))


def _drawn(artist: Artist) -> Iterator[tuple[Array, bool]]:
    """What is to be seen of an artist : (n, 2) m; and whether it is an area."""
    if empty(artist):
        return
    match artist:
        case Line2D():
            yield np.column_stack(artist.get_data(orig=True)), False
        case Polygon():
            yield artist.get_xy(), True
        case LineCollection():
            for segment in artist.get_segments():
                yield np.asarray(segment), False
        case PathCollection():
            dots = np.asarray(artist.get_offsets())
            yield np.stack([dots, dots, np.full_like(dots, np.nan)], axis=1).reshape(-1, 2), False


def _block(blocked: Booleans, boxes: Array, area: Array) -> None:
    """Tell of those boxes that are still free whether a corner of theirs is in an area. boxes :
    (n, 4), area : (m, 2) pixels
    """
    low, high = area.min(axis=0), area.max(axis=0)
    near = ~blocked & (boxes[:, 2:] > low).all(axis=1) & (boxes[:, :2] < high).all(axis=1)
    (which,) = near.nonzero()
    if len(which):
        corners = boxes[which][:, [[0, 1], [2, 1], [2, 3], [0, 3]]].reshape(-1, 2)
        blocked[which] = Path(area).contains_points(corners).reshape(-1, 4).any(axis=1)


def _inside(shape: BaseGeometry, taken: shapely.STRtree, own: int, size: Array) -> Iterator[Array]:
    """The middle of an obstacle that has room for its name."""
    for point in (shape.centroid, shape.representative_point()):
        place = np.array([point.x, point.y])
        box = _box(place, size)
        if shape.contains(box) and set(taken.query(box, "intersects").tolist()) <= {own}:
            yield place


def _beside(
    shape: BaseGeometry, taken: shapely.STRtree, window: BaseGeometry, size: Array
) -> Iterator[Array]:
    """The places right above, below, right and left of something, first about its middle, that are
    free and in the picture.
    """
    low, high = np.reshape(shape.bounds, (2, 2))
    width, height = size / 2 + GAP
    for share in ALONG:
        x, y = low + share * (high - low)
        for place in (
            (x, high[1] + height), (x, low[1] - height), (high[0] + width, y), (low[0] - width, y),
        ):  # fmt: skip
            box = _box(np.array(place), size + GAP)
            if window.contains(box) and not len(taken.query(box, "intersects")):
                yield np.array(place)


def _box(center: Array, size: Array) -> BaseGeometry:
    box: BaseGeometry = shapely.box(*(center - size / 2), *(center + size / 2))
    return box
