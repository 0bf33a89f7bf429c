"""What is drawn in one Axes: the world, the belief with the truth beside it, the beam.
Made once, then moved.

Each artist carries a gid. Colours are Okabe and Ito's; whatever a colour tells, a line style or a
marker tells too.
"""

from collections.abc import Iterator, Sized
from itertools import compress
from typing import cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from ekfsim.filters.belief import Particles
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import conditioned, cone_halfwidth, outline
from ekfsim.views.picture.outlined import OutlinedText
from ekfsim.views.playback.view import View
from ekfsim.views.words.captions import conditioned_label, cone_label, ellipse_label
from ekfsim.world import World

BLUE, SKY, GREEN, VERMILLION, PURPLE, ORANGE = (
    "#0072B2",
    "#56B4E9",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#E69F00",
)
OUTSIDE, FLOOR, OBSTACLE, EDGE, TRUTH = "#E4E4E4", "white", "#C8C8C8", "#555555", "black"
MEANT, CROWD = "#777777", "#882255"

CONE = 5.0  # body radii from the estimate to the end of its cone
NOSE = 1.7  # body radii from the reference point to the tip of the robot
TRUE_HEADING = 2.6  # body radii from the true position to the end of its segment
GRAIN, HEAVIEST = 5.0, 8.0  # points² of a particle of mean weight; the largest, in these
Dashes = str | tuple[float, tuple[float, ...]]  # "-", or where the dashes begin, and on and off
NOWHERE = np.empty((0, 2))
DOTS = 500  # corners of a path up to which each has its dot; more would be a ribbon


class WorldArtists:
    """The floor, what stands on it, and the filter's idea of it where that differs."""

    def __init__(self, axes: Axes, world: World) -> None:
        floor, told = world.map, world.told.map
        if floor.boundary is not None:
            axes.set_facecolor(OUTSIDE)
            axes.add_patch(
                Polygon(floor.boundary, facecolor=FLOOR, edgecolor="none", zorder=0.5, gid="floor")
            )
        self.obstacles = PolyCollection(
            [obstacle.points for obstacle in floor.obstacles],
            facecolors=OBSTACLE, edgecolors=EDGE, linewidths=0.9,
            zorder=1.0, gid="obstacles", label="obstacle",
        )  # fmt: skip
        axes.add_collection(self.obstacles, autolim=False)
        room = [] if floor.boundary is None else [closed(floor.boundary)]
        self.boundary = _rings(axes, room, "boundary", "wall", 1.1, "#222222", 1.6)
        believed = [] if told is floor else [closed(ring) for _, ring in told.rings()]
        self.told = _rings(axes, believed, "told-map", "filter's map", 1.2, BLUE, 1.3)
        self.told.set_linestyle((0, (4, 3)))
        self.meant = line(
            axes, "expected-path", "way that was meant", 1.25, MEANT, 1.2, (0, (5, 3))
        )
        if meant := world.expected_path is not None:
            place(self.meant, closed(world.expected_path))
        self._shown = (bool(floor.obstacles), bool(believed), bool(world.landmarks), meant)
        self.landmarks = marks(axes, "landmarks", "landmark", 1.3, EDGE, "^", 6)
        place(
            self.landmarks, np.array([(mark.x, mark.y) for mark in world.landmarks]).reshape(-1, 2)
        )

    def handles(self) -> Iterator[Artist]:
        """What the legend shows of it."""
        yield from compress((self.obstacles, self.told, self.landmarks, self.meant), self._shown)


class BeliefArtists:
    """The estimate with its ellipse, cone and path, and the truth."""

    def __init__(
        self,
        axes: Axes,
        probability: float,
        conditional: bool,
        driven: bool,
        body: bool = True,
        crowd: bool = False,
        true: bool = True,
    ) -> None:
        """driven : whether the path has a corner for each of many instants, not for each command;
        body : whether to draw the robot. For the legend, crowd : whether the belief may be
        particles; true : whether the truth is known
        """
        self._driven = driven
        self._probability, self._crowd, self._true = probability, crowd, true
        self.cone = _area(axes, SKY, 0.35, "--", 1.0, 2.0, "cone", cone_label(probability))
        label = ellipse_label(probability)
        self.ellipse = _area(axes, GREEN, 0.18, "-", 1.6, 3.1, "ellipse", label)
        self.conditioned = dict(_edges(axes, probability)) if conditional else {}
        self.particles = axes.scatter(
            [], [], s=[GRAIN], c=CROWD, alpha=0.45, linewidths=0, zorder=2.2, label="particles"
        )
        self.particles.set_gid("particles")
        self.path = line(axes, "path", "path of the estimates", 3, BLUE, 1.2)
        self.path.set(marker="" if driven else ".", markersize=5)
        self.body = _area(axes, BLUE, 0.55, "-", 1.0, 2.1, "body", "estimate") if body else None
        self.reference = marks(axes, "reference", "estimate", 4.5, BLUE, "o", 7)
        self.reference.set(markerfacecolor="white", markeredgewidth=1.5)
        self.heading = line(axes, "true-heading", "truth", 5, TRUTH, 1.6)
        self.truth = marks(axes, "truth", "truth", 5.1, TRUTH, "o", 4)

    def show(self, view: View, unit: float) -> None:
        """Move everything to a view. unit : m, what the robot's body measures in this Axes"""
        x, P = view.pose
        half = cone_halfwidth(float(P[2, 2]), self._probability)
        self.cone.set_xy(sector(x, half, CONE * unit))
        self.ellipse.set_xy(outline(x, P[:2, :2], self._probability))
        for sign, edge in self.conditioned.items():
            place(edge, outline(*conditioned(x, P, sign * half), self._probability))
        if isinstance(view.belief, Particles):
            scatter(self.particles, view.layout.pose(view.belief.states), view.belief.weights)
        elif not empty(self.particles):
            self.particles.set_offsets(NOWHERE)
        path = view.path()
        place(self.path, path)
        dot = "" if self._driven or len(path) > DOTS else "."
        if self.path.get_marker() != dot:
            self.path.set_marker(dot)
        if self.body is not None:
            self.body.set_xy(robot(x, unit))
        place(self.reference, x[None, :2])
        true = view.step.entry.truth
        segment = np.empty((0, 2)) if true is None else ray(true, TRUE_HEADING * unit)
        place(self.heading, segment)
        place(self.truth, segment[:1])

    def call(self, name: str) -> None:
        """Name the filter in the legend, where others are drawn beside it."""
        for artist in (self.body, self.reference):
            if artist is not None and name:
                artist.set_label(f"{name}: estimate")

    def handles(self) -> Iterator[Artist | tuple[Artist, ...]]:
        """What the legend shows of it."""
        yield self.reference if self.body is None else (self.body, self.reference)
        yield self.path
        yield self.ellipse
        yield self.cone
        yield from self.conditioned.values()
        if self._crowd:
            yield self.particles
        if self._true:
            yield self.heading, self.truth


def line(
    axes: Axes, gid: str, label: str, zorder: float, color: str, width: float, dashes: Dashes = "-"
) -> Line2D:
    """A line that is still to be placed."""
    made = Line2D([], [], color=color, lw=width, ls=dashes, zorder=zorder, gid=gid, label=label)
    return axes.add_line(made)


def marks(
    axes: Axes, gid: str, label: str, zorder: float, color: str, marker: str, size: float
) -> Line2D:
    """Marks that are still to be placed; filled."""
    made = Line2D([], [], color=color, ls="none", marker=marker, ms=size, zorder=zorder, gid=gid)
    made.set_label(label)
    return axes.add_line(made)


def place(line: Line2D, points: Array) -> None:
    """Move a line to points : (n, 2) m. One that had none and has none again costs no time."""
    if len(points) or not empty(line):
        line.set_data(*points.T)


def empty(artist: Artist) -> bool:
    """Whether nothing is to be seen of an artist, which drawing it would only take time to find."""
    match artist:
        case Line2D():
            return not len(cast(Sized, artist.get_xdata(orig=True)))
        case PathCollection():
            return not len(cast(Sized, artist.get_offsets()))
        case LineCollection():
            return not artist.get_paths()
        case OutlinedText():
            return not artist.get_text()
    return False


def scatter(crowd: PathCollection, poses: Array, weights: Array) -> None:
    """Draw particles as dots whose areas are their weights. poses : (p, 3), weights : (p,)"""
    finite = np.isfinite(poses[:, :2]).all(axis=-1)
    areas = GRAIN * np.minimum(weights * len(weights), HEAVIEST)
    crowd.set_offsets(poses[finite, :2])
    crowd.set_sizes(areas[finite])


def robot(x: Array, size: float) -> Array:
    """A round body with a pointed nose : (n, 2) m"""
    around = np.linspace(np.radians(50), np.radians(310), 27) + x[2]
    return np.concatenate(
        [x[:2] + size * direction(around), [x[:2] + NOSE * size * direction(x[2])]]
    )


def sector(x: Array, half: float, radius: float) -> Array:
    """The headings within `half` rad of the estimate's, from its position : (n, 2) m"""
    half = min(half, np.pi)
    arc = x[2] + np.linspace(-half, half, 3 + int(np.degrees(half)))
    return np.concatenate([[x[:2]], x[:2] + radius * direction(arc)])


def direction(angle: Array | float) -> Array:
    """Unit vectors : (…, 2)"""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def closed(ring: Array) -> Array:
    """The ring with its first point once more at the end : (n + 1, 2) m"""
    return np.concatenate([ring, ring[:1]])


def ray(pose: Array, length: float, far: float = 0.0) -> Array:
    """From a pose straight ahead, `far` m where the length is nan : (2, 2) m"""
    return np.stack(
        [pose[:2], pose[:2] + (far if np.isnan(length) else length) * direction(pose[2])]
    )


def _rings(
    axes: Axes, rings: list[Array], gid: str, label: str, zorder: float, color: str, width: float
) -> LineCollection:
    """Closed outlines : (n, 2) m each"""
    made = LineCollection(
        rings, colors=color, linewidths=width, zorder=zorder, gid=gid, label=label
    )
    axes.add_collection(made, autolim=False)
    return made


def _edges(axes: Axes, probability: float) -> Iterator[tuple[int, Line2D]]:
    """The ellipses for the heading at either edge of its cone."""
    for sign, gid, color, dashes in (
        (1, "ellipse-plus", PURPLE, (6, 2)),
        (-1, "ellipse-minus", ORANGE, (1, 1)),
    ):
        label = conditioned_label(probability, sign)
        yield sign, line(axes, gid, label, 2.4, color, 1.8, (0, dashes))


def _area(
    axes: Axes,
    color: str,
    alpha: float,
    style: str,
    width: float,
    zorder: float,
    gid: str,
    label: str,
) -> Polygon:
    area = Polygon(
        np.zeros((1, 2)),
        facecolor=to_rgba(color, alpha),
        edgecolor=color,
        linestyle=style,
        linewidth=width,
    )
    area.set(zorder=zorder, gid=gid, label=label)
    axes.add_patch(area)
    return area
