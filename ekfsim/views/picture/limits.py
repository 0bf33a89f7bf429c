"""How much of the plane a run's pictures show: fixed for the whole run, so that nothing jumps."""

import functools
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.filters.belief import Belief
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.models.layout import Layout
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.picture.sights import sight
from ekfsim.views.playback.view import View
from ekfsim.world import World

MARGIN = 0.05  # of the larger side, all around: room for the robot's body and the line widths
LEAST = 1e-3  # m; a world of one point is still this wide


@dataclass(frozen=True, slots=True)
class Limits:
    """A rectangle with its sides along the axes. All in m."""

    left: float
    bottom: float
    right: float
    top: float

    @classmethod
    def around(cls, points: Array) -> Self:
        """The smallest that holds all the finite ones of (n, 2) points;
        the unit square where there is none.
        """
        finite = points[np.isfinite(points).all(axis=-1)]
        if len(finite) == 0:
            return cls(0.0, 0.0, 1.0, 1.0)
        left, bottom = finite.min(axis=0).tolist()
        right, top = finite.max(axis=0).tolist()
        return cls(left, bottom, right, top)

    @property
    def width(self) -> float:
        """From left to right."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """From bottom to top."""
        return self.top - self.bottom

    @property
    def size(self) -> float:
        """The longer side: what the robot's body and the cone are measured by."""
        return max(self.width, self.height, LEAST)

    def joined(self, other: "Limits") -> "Limits":
        """The smallest rectangle that holds both."""
        return Limits(
            min(self.left, other.left),
            min(self.bottom, other.bottom),
            max(self.right, other.right),
            max(self.top, other.top),
        )

    def cut(self, other: "Limits") -> "Limits":
        """The part of this rectangle inside the other; they must meet."""
        return Limits(
            max(self.left, other.left),
            max(self.bottom, other.bottom),
            min(self.right, other.right),
            min(self.top, other.top),
        )

    def grown(self, by: float) -> "Limits":
        """With `by` m more on every side."""
        return Limits(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def shaped(self, aspect: float) -> "Limits":
        """Grown to the shape of a box whose width is `aspect` times its height,
        about the same centre.
        """
        width, height = (
            max(self.width, self.height * aspect, LEAST),
            max(self.height, self.width / aspect, LEAST / aspect),
        )
        x, y = (self.left + self.right) / 2, (self.bottom + self.top) / 2
        return Limits(x - width / 2, y - height / 2, x + width / 2, y + height / 2)

    def hold(self, points: Array) -> bool:
        """Whether all finite ones of (n, 2) points lie inside."""
        around = Limits.around(points)
        return not np.isfinite(points).all(axis=-1).any() or self.joined(around) == self


class _Box:
    """A rectangle that grows around points,
    one at a time and as fast as a run of many thousand steps asks for.
    """

    __slots__ = ("bottom", "left", "right", "top")

    def __init__(self) -> None:
        self.left = self.bottom = math.inf
        self.right = self.top = -math.inf

    def hold(self, x: float, y: float) -> None:
        """Grow to hold a point, if it is finite."""
        if not -math.inf < x < math.inf or not -math.inf < y < math.inf:
            return
        if x < self.left:
            self.left = x
        if x > self.right:
            self.right = x
        if y < self.bottom:
            self.bottom = y
        if y > self.top:
            self.top = y

    @property
    def limits(self) -> Limits | None:
        """What it holds, None where that is nothing."""
        return (
            Limits(self.left, self.bottom, self.right, self.top)
            if self.left <= self.right
            else None
        )


def of(scene: Scene, steps: Iterable[Step], probability: float = 0.954) -> Limits:
    """The limits of a run: both maps, every estimate and every truth,
    whatever else a picture shows of them.

    Ellipses, recorded fixes and the ends of readings are held as well, up to twice the size of all
    that: one that is larger than the world must not shrink the world to a dot. The steps are read
    once and none is kept.
    """
    layout, k = scene.world.layout, radius_factor(probability)
    must, may = _Box(), _Box()
    for points in _drawn(scene.world):
        for x, y in points.tolist():
            must.hold(x, y)
    last: Belief | None = None
    for step in steps:
        for belief in (step.posterior,) if step.prior is last else (step.prior, step.posterior):
            _hold(must, may, belief, layout, k)
        last, entry = step.posterior, step.entry
        if entry.truth is not None:
            x, y, _ = entry.truth.tolist()
            must.hold(x, y)
        if entry.fix is not None:
            may.hold(*entry.fix.tolist())
        if isinstance(entry.given, Reading):
            for x, y in _reached(step):
                may.hold(x, y)
    core, wide = must.limits or Limits(0.0, 0.0, 1.0, 1.0), may.limits
    if wide is not None:
        core = (
            core.joined(wide.cut(core.grown(core.size / 2)))
            if core.size > LEAST
            else core.joined(wide)
        )
    return core.grown(MARGIN * core.size)


def of_all(scene: Scene, runs: Iterable[Iterable[Step]], probability: float = 0.954) -> Limits:
    """The limits of a run that several filters watch."""
    return functools.reduce(Limits.joined, (of(scene, steps, probability) for steps in runs))


def _hold(must: _Box, may: _Box, belief: Belief, layout: Layout, k: float) -> None:
    """Hold the estimated position, and the box about its ellipse. k : the ellipse's radii in σ"""
    i, j = layout.position
    mean, P = belief
    x, y = float(mean[i]), float(mean[j])
    must.hold(x, y)
    variance_x, variance_y = float(P[i, i]), float(P[j, j])
    east = k * math.sqrt(variance_x) if variance_x > 0 else 0.0
    north = k * math.sqrt(variance_y) if variance_y > 0 else 0.0
    may.hold(x - east, y - north)
    may.hold(x + east, y + north)


def including(limits: Limits, view: View) -> Limits:
    """The same limits where they hold the view's estimate and truth, else doubled until they do."""
    points = np.concatenate([positions(each.step) for each in (view, *view.others)])
    if limits.hold(points):
        return limits
    return limits.joined(Limits.around(points).grown(limits.size / 2))


def positions(step: Step) -> Array:
    """What must never be cut off: the estimates before and after, and the truth : (n, 2) m"""
    known = [step.layout.pose(step.prior.mean), step.layout.pose(step.posterior.mean)]
    return np.array(
        [pose[:2] for pose in (*known, *([] if step.entry.truth is None else [step.entry.truth]))]
    )


def _reached(step: Step) -> Iterator[list[float]]:
    """The end of what is drawn of a reading, x and y in m."""
    given = step.entry.given
    if isinstance(given, Reading) and isinstance(given.sensor, Laser):
        x, y, θ = step.prior.mean.tolist()
        direction = θ + given.sensor.bearing
        yield [
            x + float(given.z[0]) * math.cos(direction),
            y + float(given.z[0]) * math.sin(direction),
        ]
    elif (seen := sight(step)) is not None:
        yield from seen.end.tolist()
        yield from seen.place.tolist()


def _drawn(world: World) -> Iterator[Array]:
    """Everything that stands in either map : (n, 2) m each"""
    for floor in (world.map, world.told.map):
        for _, ring in floor.rings():
            yield ring
    for landmark in world.landmarks:
        yield np.array([[landmark.x, landmark.y]])
    if world.expected_path is not None:
        yield world.expected_path
