"""How much of the plane a run's pictures show: fixed for the whole run, so that nothing jumps."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.models.laser import Laser
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.playback import View
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
        """The smallest that holds all the finite ones of (n, 2) points; the unit square where there is none."""
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
        """Grown to the shape of a box whose width is `aspect` times its height, about the same centre."""
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


def of(scene: Scene, steps: Iterable[Step], probability: float = 0.954) -> Limits:
    """The limits of a run: both maps, every estimate and every truth, whatever else a picture shows of them.

    Ellipses and beams' ends are held as well, up to twice the size of all that: one that is larger than the world must
    not shrink the world to a dot. The steps are read once and none is kept.
    """
    held = [corner for points in _drawn(scene.world) for corner in points]
    core = Limits.around(np.array(held).reshape(-1, 2)) if held else None
    wide: Limits | None = None
    for step in steps:
        here = Limits.around(positions(step))
        core = here if core is None else core.joined(here)
        reach = Limits.around(_reached(step, probability))
        wide = reach if wide is None else wide.joined(reach)
    if core is None:
        core = Limits(0.0, 0.0, 1.0, 1.0)
    if wide is not None:
        core = core.joined(wide.cut(core.grown(core.size / 2))) if core.size > LEAST else core.joined(wide)
    return core.grown(MARGIN * core.size)


def including(limits: Limits, view: View) -> Limits:
    """The same limits where they hold the view's estimate and truth, else doubled until they do."""
    points = positions(view.step)
    if limits.hold(points):
        return limits
    return limits.joined(Limits.around(points).grown(limits.size / 2))


def positions(step: Step) -> Array:
    """What must never be cut off: the estimates before and after, and the truth : (n, 2) m"""
    known = [step.prior.mean, step.posterior.mean, *([] if step.entry.truth is None else [step.entry.truth])]
    return np.array([state[:2] for state in known])


def _reached(step: Step, probability: float) -> Array:
    """The corners of the boxes about the ellipses, and the end of the beam : (n, 2) m"""
    k = radius_factor(probability)
    points = []
    for x, P in (step.prior, step.posterior):
        arms = k * np.sqrt(np.maximum(np.diagonal(P)[:2], 0.0))
        points += [x[:2] - arms, x[:2] + arms]
    given = step.entry.given
    if isinstance(given, Reading) and isinstance(given.sensor, Laser):
        direction = step.prior.mean[2] + given.sensor.bearing
        points.append(step.prior.mean[:2] + given.z * np.array([np.cos(direction), np.sin(direction)]))
    return np.array(points)


def _drawn(world: World) -> Iterator[Array]:
    """Everything that stands in either map : (n, 2) m each"""
    for floor in (world.map, world.told.map):
        for _, ring in floor.rings():
            yield ring
    for landmark in world.landmarks:
        yield np.array([[landmark.x, landmark.y]])
