"""What is drawn in one Axes of a reading that is no beam, and of fixes that were only recorded."""

from collections.abc import Iterable, Iterator
from typing import Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

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
from ekfsim.views.picture.artists import BLUE, IN_AIR, IN_WALL, VERMILLION, place
from ekfsim.views.picture.sights import NOWHERE, Sight

FIX = "#7A7A7A"
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


class SightArtists:
    """A reading as measured, as it was expected, and the landmark that it is of."""

    def __init__(self, axes: Axes, sensors: Iterable[type[Sensor]] = ()) -> None:
        """sensors : the kinds whose readings may come, for the legend"""
        self._sensors: set[type] = set(sensors) & set(LABELS)
        words = {LABELS[sensor] for sensor in self._sensors}
        self.way = axes.add_line(
            Line2D([], [], color=BLUE, lw=1, ls=":", zorder=3.3, gid="sight-way")
        )
        self.way.set_label("as it was expected")
        self.line = axes.add_line(Line2D([], [], color=VERMILLION, lw=2, zorder=3.4, gid="sight"))
        self.line.set_label(words.pop() if len(words) == 1 else SEVERAL)
        self.place = axes.add_line(_hollow(VERMILLION, "o", 11, 3.5, "sight-place"))
        self.place.set_label("landmark that it is of")
        self.expected = axes.add_line(_hollow(BLUE, "D", 6, 4.6, "sight-expected"))
        self.expected.set_label("where it was expected")
        self.end = axes.add_line(_hollow(VERMILLION, "o", 7, 4.7, "sight-end"))

    def show(self, sight: Sight | None) -> None:
        """Move it to a reading, or away."""
        lines = (self.line, self.end, self.way, self.expected, self.place)
        for line, points in zip(lines, _points(sight), strict=True):
            place(line, points)
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
        yield (self.line, end) if points else self.line
        yield Line2D([], [], color=VERMILLION, lw=2, ls="--", label="… is refused")
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
        self.fixes = axes.add_line(
            Line2D([], [], color=FIX, ls="none", marker="+", ms=6, mew=1.0, zorder=2.9, gid="fixes")
        )
        self.fixes.set_label("fix, recorded and not used")

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
    """Where in a log each fix comes up, and the fixes : (n,), (n, 2) m; one that is repeated counts
    once.
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


def mark(line: Line2D, fix: bool, refused: bool) -> Line2D:
    """A disc for a landmark's place, a cross for the robot's; hollow where the reading is
    refused.
    """
    line.set(marker=IN_WALL if fix else IN_AIR, markersize=8 if fix else 7, markeredgewidth=1.5)
    line.set_markerfacecolor("white" if refused else VERMILLION)
    return line


def _hollow(color: str, marker: Literal["o", "D"], size: float, zorder: float, gid: str) -> Line2D:
    """Marks without a line and without a face."""
    line = Line2D(
        [], [], color=color, ls="none", marker=marker, ms=size, mfc="none", mew=1.2, zorder=zorder
    )
    line.set_gid(gid)
    return line


def _points(sight: Sight | None) -> tuple[Array, ...]:
    return (
        (NOWHERE,) * 5
        if sight is None
        else (sight.line, sight.end, sight.way, sight.expected, sight.place)
    )
