"""What is drawn in one Axes is made once, then moved: what it is made of, and the world.

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

from ekfsim.geometry import Array
from ekfsim.views.picture.written.outlined import OutlinedText
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
            [obstacle.outline for obstacle in floor.obstacles],
            facecolors=OBSTACLE, edgecolors=EDGE, linewidths=0.9,
            zorder=1.0, gid="obstacles", label="obstacle",
        )  # fmt: skip
        axes.add_collection(self.obstacles, autolim=False)
        room = [] if floor.boundary is None else [closed(floor.boundary)]
        self.boundary = _lines(axes, room, "boundary", "wall", 1.1, "#222222", 1.6)
        self.lines = _lines(
            axes, [each.points for each in floor.lines], "walls", "wall", 1.1, "#222222", 1.6
        )
        believed = [] if told is floor else [line for _, line in told.outlines()]
        self.told = _lines(axes, believed, "told-map", "filter's map", 1.2, BLUE, 1.3)
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


def area(
    axes: Axes,
    color: str,
    alpha: float,
    dashes: Dashes,
    width: float,
    zorder: float,
    gid: str,
    label: str,
) -> Polygon:
    """An area that is still to be placed. alpha : of its face"""
    made = Polygon(
        NOWHERE,
        facecolor=to_rgba(color, alpha),
        edgecolor=color,
        linestyle=dashes,
        linewidth=width,
    )
    made.set(zorder=zorder, gid=gid, label=label)
    axes.add_patch(made)
    return made


def line(
    axes: Axes, gid: str, label: str, zorder: float, color: str, width: float, dashes: Dashes = "-"
) -> Line2D:
    """A line that is still to be placed."""
    made = Line2D([], [], color=color, lw=width, ls=dashes, zorder=zorder, gid=gid, label=label)
    axes.add_artist(made)  # add_line would look at how far it reaches, as well
    return made


def marks(
    axes: Axes, gid: str, label: str, zorder: float, color: str, marker: str, size: float
) -> Line2D:
    """Marks that are still to be placed; filled."""
    made = Line2D([], [], color=color, ls="none", marker=marker, ms=size, zorder=zorder, gid=gid)
    made.set_label(label)
    axes.add_artist(made)
    return made


def place(line: Line2D, points: Array) -> None:
    """Move a line to points : (n, 2) m. One that had none and has none again costs no time."""
    if len(points) or not empty(line):
        line.set_data(*points.T)


def empty(artist: Artist) -> bool:
    """Whether nothing is to be seen of an artist, which drawing it would only take time to find."""
    if isinstance(artist, Line2D):  # most are one
        return not len(cast(Sized, artist.get_xdata(orig=True)))
    match artist:
        case Polygon():
            return not len(cast(Sized, artist.get_path().vertices))
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


def _lines(
    axes: Axes, rings: list[Array], gid: str, label: str, zorder: float, color: str, width: float
) -> LineCollection:
    """Lines that stand still : (n, 2) m each"""
    made = LineCollection(
        rings, colors=color, linewidths=width, zorder=zorder, gid=gid, label=label
    )
    axes.add_collection(made, autolim=False)
    return made
