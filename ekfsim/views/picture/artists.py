"""What is drawn in one Axes: the world, the belief with the truth beside it, the beam. Made once,
then moved.

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

from ekfsim.filters.belief import Particles, Refused
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import conditioned, cone_halfwidth, outline
from ekfsim.views.picture.outlined import OutlinedText
from ekfsim.views.terminal.playback import View
from ekfsim.views.words.beams import Beam
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
# points², of a particle of mean weight; and how many times as large one may be
GRAIN, HEAVIEST = 5.0, 8.0
IN_AIR, IN_WALL = "o", "X"  # markers at the end of a beam
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
            facecolors=OBSTACLE,
            edgecolors=EDGE,
            linewidths=0.9,
            zorder=1.0,
            gid="obstacles",
            label="obstacle",
        )
        axes.add_collection(self.obstacles, autolim=False)
        room = [] if floor.boundary is None else [closed(floor.boundary)]
        self.boundary = LineCollection(
            room, colors="#222222", linewidths=1.6, zorder=1.1, gid="boundary", label="wall"
        )
        axes.add_collection(self.boundary, autolim=False)
        believed = [] if told is floor else [closed(ring) for _, ring in told.rings()]
        self.told = LineCollection(
            believed,
            colors=BLUE,
            linewidths=1.3,
            linestyles=[(0, (4, 3))],
            zorder=1.2,
            gid="told-map",
            label="filter's map",
        )
        axes.add_collection(self.told, autolim=False)
        self.meant = Line2D(
            *(NOWHERE if world.expected_path is None else closed(world.expected_path)).T,
            color=MEANT, lw=1.2, ls=(0, (5, 3)), zorder=1.25, gid="expected-path",
            label="way that was meant",
        )  # fmt: skip
        axes.add_line(self.meant)
        meant = world.expected_path is not None
        self._shown = (bool(floor.obstacles), bool(believed), bool(world.landmarks), meant)
        marks = np.array([[mark.x, mark.y] for mark in world.landmarks]).reshape(-1, 2)
        self.landmarks = Line2D(
            *marks.T,
            linestyle="none",
            marker="^",
            color=EDGE,
            ms=6,
            zorder=1.3,
            gid="landmarks",
            label="landmark",
        )
        axes.add_line(self.landmarks)

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
        """driven : whether the path has a corner for each of many instants, rather than for each
        command

        body : whether to draw the robot; for the legend, crowd : whether the belief may be
        particles, true : whether the truth is known
        """
        self._driven = driven
        self._probability, self._crowd, self._true = probability, crowd, true
        self.cone = _area(axes, SKY, 0.35, "--", 1.0, 2.0, "cone", cone_label(probability))
        self.ellipse = _area(
            axes, GREEN, 0.18, "-", 1.6, 3.1, "ellipse", ellipse_label(probability)
        )
        self.conditioned: dict[int, Line2D] = {}
        for sign, gid, color, dashes in (
            (1, "ellipse-plus", PURPLE, (6, 2)),
            (-1, "ellipse-minus", ORANGE, (1, 1)),
        ):
            if conditional:
                label = conditioned_label(probability, sign)
                line = Line2D(
                    [], [], color=color, lw=1.8, ls=(0, dashes), zorder=2.4, gid=gid, label=label
                )
                self.conditioned[sign] = axes.add_line(line)
        self.particles = axes.scatter(
            [],
            [],
            s=[GRAIN],
            c=CROWD,
            alpha=0.45,
            linewidths=0,
            zorder=2.2,
            gid="particles",
            label="particles",
        )
        self.path = axes.add_line(
            Line2D(
                [], [], color=BLUE, lw=1.2, marker="" if driven else ".", ms=5, zorder=3, gid="path"
            )
        )
        self.path.set_label("path of the estimates")
        self.body = _area(axes, BLUE, 0.55, "-", 1.0, 2.1, "body", "estimate") if body else None
        self.reference = axes.add_line(
            Line2D(
                [],
                [],
                color=BLUE,
                ls="none",
                marker="o",
                ms=7,
                mfc="white",
                mew=1.5,
                zorder=4.5,
                gid="reference",
            )
        )
        self.reference.set_label("estimate")
        self.heading = axes.add_line(
            Line2D([], [], color=TRUTH, lw=1.6, zorder=5, gid="true-heading", label="truth")
        )
        self.truth = axes.add_line(
            Line2D(
                [],
                [],
                color=TRUTH,
                ls="none",
                marker="o",
                ms=4,
                zorder=5.1,
                gid="truth",
                label="truth",
            )
        )

    def show(self, view: View, unit: float) -> None:
        """Move everything to a view. unit : m, what the robot's body measures in this Axes"""
        x, P = view.pose
        half = cone_halfwidth(float(P[2, 2]), self._probability)
        self.cone.set_xy(sector(x, half, CONE * unit))
        self.ellipse.set_xy(outline(x, P[:2, :2], self._probability))
        for sign, line in self.conditioned.items():
            place(line, outline(*conditioned(x, P, sign * half), self._probability))
        if isinstance(view.belief, Particles):
            scatter(self.particles, view.layout.pose(view.belief.states), view.belief.weights)
        else:
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
        segment = np.empty((0, 2)) if true is None else _ray(true, TRUE_HEADING * unit)
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


class BeamArtists:
    """The beam from the estimate with the measured length, and where the filter expected it to
    end.
    """

    def __init__(self, axes: Axes) -> None:
        self.probes = LineCollection(
            [], colors=VERMILLION, linewidths=0.9, linestyles=":", zorder=3.2, gid="probes"
        )
        self.probes.set_label("ambiguous: from within 3 σ")
        axes.add_collection(self.probes, autolim=False)
        self.arms = axes.add_line(
            Line2D(
                [],
                [],
                color=VERMILLION,
                lw=0.9,
                marker="o",
                ms=3,
                markevery=(1, 2),
                zorder=3.2,
                gid="arms",
            )
        )
        self.measured = axes.add_line(
            Line2D(
                [], [], color=VERMILLION, lw=2, zorder=3.4, gid="beam", label="beam, as measured"
            )
        )
        self.way = axes.add_line(
            Line2D([], [], color=BLUE, lw=1, ls=":", zorder=3.3, gid="expected-way")
        )
        self.expected = axes.add_line(
            Line2D(
                [],
                [],
                color=BLUE,
                ls="none",
                marker="D",
                ms=6,
                mfc="none",
                mew=1.2,
                zorder=3.9,
                gid="expected",
            )
        )
        self.expected.set_label("where it was expected to end")
        self.end = axes.add_line(
            Line2D([], [], color=VERMILLION, ls="none", ms=8, mew=1.5, zorder=3.8, gid="beam-end")
        )

    def show(self, beam: Beam | None, far: float) -> None:
        """Move it to a beam, or away. far : m, how long a beam is drawn that meets nothing"""
        for line in (self.measured, self.end, self.way, self.expected, self.arms):
            place(line, NOWHERE)
        if beam is not None or not empty(self.probes):
            self.probes.set_segments(
                [] if beam is None else [_ray(*probe, far) for probe in beam.probes]
            )
        if beam is None:
            return
        arms = [point for probe in beam.probes for point in (beam.pose[:2], probe.pose[:2])]
        place(self.arms, np.reshape(arms, (-1, 2)))
        echo = not np.isnan(beam.measured)
        self.measured.set_linestyle(":" if not echo else "--" if beam.refused else "-")
        place(self.measured, _ray(beam.pose, beam.measured, far))
        if echo:
            place(self.end, _ray(beam.pose, beam.measured)[1:])
            mark_end(self.end, beam.solid, beam.refused)
        if not np.isnan(beam.predicted):
            way = _ray(beam.pose, beam.predicted)
            place(self.way, way)
            place(self.expected, way[1:])

    def handles(self) -> Iterator[Artist]:
        """What the legend shows of it."""
        yield self.measured
        for solid, label in ((False, "… ends in the air"), (True, "… ends in or behind a wall")):
            yield mark_end(
                Line2D([], [], color=VERMILLION, ls="none", ms=7, mew=1.5, label=label), solid
            )
        yield Line2D([], [], color=VERMILLION, lw=2, ls="--", label="… is refused")
        yield self.expected
        yield Line2D([], [], color=VERMILLION, lw=1, ls=":", label=str(self.probes.get_label()))


def mark_end(line: Line2D, solid: bool, refused: Refused = Refused.NOT) -> Line2D:
    """A ring for an end in the air, a cross for one in a wall; the cross of a refused reading is
    hollow.
    """
    line.set_marker(IN_WALL if solid else IN_AIR)
    line.set_markerfacecolor(VERMILLION if solid and not refused else "white")
    return line


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


def _ray(pose: Array, length: float, far: float = 0.0) -> Array:
    """From a pose straight ahead, `far` m where the length is nan : (2, 2) m"""
    return np.stack(
        [pose[:2], pose[:2] + (far if np.isnan(length) else length) * direction(pose[2])]
    )


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
