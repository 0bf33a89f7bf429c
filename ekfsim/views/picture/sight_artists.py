"""What is drawn in one Axes of a reading, be it a beam or not, and of fixes only recorded."""

from collections.abc import Iterable, Iterator

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.models.protocols import Sensor
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.records import Entry
from ekfsim.scene import Scene
from ekfsim.systems.robots import PylonCart
from ekfsim.views.picture.artists import (
    BLUE,
    VERMILLION,
    empty,
    line,
    marks,
    place,
    ray,
)
from ekfsim.views.picture.sights import NOWHERE, Sight
from ekfsim.views.words.beams.beam import Beam

FIX = "#7A7A7A"
IN_AIR, IN_WALL = "o", "X"  # markers at the end of a reading
OTHERWISE = (0, (1.2, 0.6))  # dashes of a wall that a beam may meet instead
SEVERAL = "reading, as measured"
LABELS: dict[type, str] = {
    MarkerAngles: "direction, as measured",
    BearingOnly: "direction, as measured",
    RangeBearing: "landmark, as measured",
    RangeOnly: "range, as measured",
    Position: "fix as measured, with 1 σ",
    LandmarkOffset: "offset, as measured",
    LidarOffset: "offset, as measured",
    Yaw: "heading, as measured",
}
DIRECTIONS = {MarkerAngles, BearingOnly, Yaw}  # the way that was expected ends nowhere
# a reading of these puts something at a point
POINTS = {RangeBearing, LandmarkOffset, LidarOffset, Position}


class BeamArtists:
    """The beam from the estimate with the measured length,
    and where the filter expected it to end.
    """

    def __init__(self, axes: Axes) -> None:
        self.probes = LineCollection(
            [], colors=VERMILLION, linewidths=0.9, linestyles=":", zorder=3.2, gid="probes"
        )
        self.probes.set_label("ambiguous: from within 3 σ")
        axes.add_collection(self.probes, autolim=False)
        self.walls = LineCollection(
            [], colors=VERMILLION, linewidths=3.5, linestyles=OTHERWISE, zorder=1.4,
            gid="other-walls", label="wall that it may meet instead",
        )  # fmt: skip
        axes.add_collection(self.walls, autolim=False)
        self.arms = line(axes, "arms", "", 3.2, VERMILLION, 0.9)
        self.arms.set(marker="o", markersize=3, markevery=(1, 2))
        self.measured = line(axes, "beam", "beam, as measured", 3.4, VERMILLION, 2)
        self.way = line(axes, "expected-way", "", 3.3, BLUE, 1, ":")
        self.expected = hollow(axes, "expected", "where it was expected to end", 3.9, BLUE, "D", 6)
        self.end = marks(axes, "beam-end", "", 3.8, VERMILLION, "", 8)
        self.end.set_markeredgewidth(1.5)
        # never drawn: what the legend shows, and where what it stands for is to be seen
        self._plain = _sample("beam, as measured", "-")
        self._refused = _sample("beam, as measured, refused", "--")
        self._lost = _sample("beam without an echo", ":")
        self._air, self._wall = (
            mark_end(Line2D([], [], color=VERMILLION, ls="none", ms=7, mew=1.5, label=label), solid)
            for solid, label in ((False, "… ends in the air"), (True, "… ends in or behind a wall"))
        )
        self._ambiguous = _sample(str(self.probes.get_label()), ":", 1)

    def show(self, beam: Beam | None, far: float) -> None:
        """Move it to a beam, or away. far : m, how long a beam is drawn that meets nothing"""
        samples = self._plain, self._refused, self._lost, self._air, self._wall, self._ambiguous
        for one in (self.measured, self.end, self.way, self.expected, self.arms, *samples):
            place(one, NOWHERE)
        if beam is not None or not empty(self.probes):
            self.probes.set_segments(
                [] if beam is None else [ray(*probe, far) for probe in beam.probes]
            )
            self.walls.set_segments([] if beam is None else list(beam.walls))
        if beam is None:
            return
        arms = [point for probe in beam.probes for point in (beam.pose[:2], probe.pose[:2])]
        place(self.arms, np.reshape(arms, (-1, 2)))
        echo = not np.isnan(beam.measured)
        self.measured.set_linestyle(":" if not echo else "--" if beam.refused else "-")
        seen = ray(beam.pose, beam.measured, far)
        place(self.measured, seen)
        place(self._lost if not echo else self._refused if beam.refused else self._plain, seen)
        if beam.probes:
            place(self._ambiguous, seen)
        if echo:
            place(self._wall if beam.solid else self._air, seen[1:])
            place(self.end, seen[1:])
            mark_end(self.end, beam.solid, beam.refused)
        if not np.isnan(beam.predicted):
            way = ray(beam.pose, beam.predicted)
            place(self.way, way)
            place(self.expected, way[1:])

    def handles(self) -> Iterator[Artist]:
        """What the legend shows of it."""
        yield from (self._plain, self._refused, self._lost, self._air, self._wall)
        yield from (self.expected, self._ambiguous, self.walls)


class SightArtists:
    """A reading as measured, as it was expected, and the landmark that it is of."""

    def __init__(self, axes: Axes, sensors: Iterable[type[Sensor]] = ()) -> None:
        """sensors : the kinds whose readings may come, for the legend"""
        self._sensors: set[type] = set(sensors) & set(LABELS)
        words = {LABELS[sensor] for sensor in self._sensors}
        label = words.pop() if len(words) == 1 else SEVERAL
        self.way = line(axes, "sight-way", "as it was expected", 3.3, BLUE, 1, ":")
        self.line = line(axes, "sight", label, 3.4, VERMILLION, 2)
        self.place = hollow(axes, "sight-place", "landmark that it is of", 3.5, VERMILLION, "o", 11)
        self.expected = hollow(axes, "sight-expected", "where it was expected", 4.6, BLUE, "D", 6)
        self.end = hollow(axes, "sight-end", "", 4.7, VERMILLION, "o", 7)
        self._plain, self._refused = _sample(label, "-"), _sample(f"{label}, refused", "--")

    def show(self, sight: Sight | None) -> None:
        """Move it to a reading, or away."""
        lines = (self.line, self.end, self.way, self.expected, self.place)
        for one, points in zip(lines, _points(sight), strict=True):
            place(one, points)
        for sample, is_refused in ((self._plain, False), (self._refused, True)):
            known = sight is not None and bool(sight.refused) == is_refused
            place(sample, sight.line if sight is not None and known else NOWHERE)
        if sight is not None:
            self.line.set_linestyle("--" if sight.refused else "-")
            self.line.set_linewidth(1.4 if sight.fix else 2)
            mark(self.end, sight.fix, bool(sight.refused))

    def handles(self) -> Iterator[Artist | tuple[Artist, ...]]:
        """What the legend shows of it."""
        if not self._sensors:
            return
        points = POINTS & self._sensors
        end = mark(Line2D([], [], color=VERMILLION, ls="none"), points == {Position}, refused=False)
        yield (self._plain, end) if points else self._plain
        yield self._refused
        yield self.way if self._sensors <= DIRECTIONS else self.expected
        if self._sensors - {Position, Yaw}:
            yield self.place


class FixArtists:
    """The fixes that were recorded up to now and that the filter is not given."""

    def __init__(self, axes: Axes, scene: Scene) -> None:
        self._index, self._fixes = recorded_fixes(() if scene.log is None else scene.log.entries)
        self._shown = bool(len(self._fixes)) or (
            scene.drive is not None and isinstance(scene.world.robot, PylonCart)
        )
        self.fixes = marks(axes, "fixes", "fix, recorded and not used", 2.9, FIX, "+", 6)
        self.fixes.set_markeredgewidth(1.0)

    def show(self, entry: Entry) -> None:
        """The fixes of a log up to this entry; of a drive, the newest."""
        if len(self._fixes):
            shown = self._fixes[: np.searchsorted(self._index, entry.index, side="right")]
        else:
            shown = (
                NOWHERE
                if entry.fix is None or not np.isfinite(entry.fix).all()
                else entry.fix[None]
            )
        place(self.fixes, shown)

    def handles(self) -> Iterator[Artist]:
        """What the legend shows of it."""
        if self._shown:
            yield self.fixes


def recorded_fixes(entries: Iterable[Entry]) -> tuple[Array, Array]:
    """Where in a log each fix comes up, and the fixes : (n,), (n, 2) m;
    one that is repeated counts once.
    """
    index: list[int] = []
    fixes: list[tuple[float, float]] = []
    for entry in entries:
        if entry.fix is not None:
            x, y = entry.fix.tolist()
            if (not fixes or fixes[-1] != (x, y)) and np.isfinite(x + y):
                index.append(entry.index)
                fixes.append((x, y))
    return np.array(index), np.array(fixes).reshape(-1, 2)


def _sample(label: str, dashes: str, width: float = 2) -> Line2D:
    """A line for the legend."""
    return Line2D([], [], color=VERMILLION, lw=width, ls=dashes, label=label)


def mark_end(line: Line2D, solid: bool, refused: Refused = Refused.NOT) -> Line2D:
    """A ring for an end in the air, a cross for one in a wall;
    the cross of a refused reading is hollow.
    """
    line.set_marker(IN_WALL if solid else IN_AIR)
    line.set_markerfacecolor(VERMILLION if solid and not refused else "white")
    return line


def mark(line: Line2D, fix: bool, refused: bool) -> Line2D:
    """A disc for a landmark's place, a cross for the robot's;
    hollow where the reading is refused.
    """
    line.set(marker=IN_WALL if fix else IN_AIR, markersize=8 if fix else 7, markeredgewidth=1.5)
    line.set_markerfacecolor("white" if refused else VERMILLION)
    return line


def hollow(
    axes: Axes, gid: str, label: str, zorder: float, color: str, marker: str, size: float
) -> Line2D:
    """Marks without a face, still to be placed."""
    made = marks(axes, gid, label, zorder, color, marker, size)
    made.set(markerfacecolor="none", markeredgewidth=1.2)
    return made


def _points(sight: Sight | None) -> tuple[Array, ...]:
    return (
        (NOWHERE,) * 5
        if sight is None
        else (sight.line, sight.end, sight.way, sight.expected, sight.place)
    )
