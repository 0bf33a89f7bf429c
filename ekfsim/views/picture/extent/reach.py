"""How far a run reaches: everything that its pictures show of it, step by step and in one pass."""

import math
from array import array
from collections.abc import Iterator

import numpy as np

from ekfsim.diagnostics.unplaced import Unplaced
from ekfsim.filters.belief import Belief
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Reading, Step
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.sights import sight

FINE = 0.01  # of its own size: by how much the reach must have grown to be kept anew


class Box:
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

    def within(self, other: Limits) -> bool:
        """Whether all of it lies in a rectangle."""
        return (
            self.left >= other.left
            and self.right <= other.right
            and self.bottom >= other.bottom
            and self.top <= other.top
        )


class Reach:
    """What one filter's run has reached up to each of its instants.

    An instant is that of a step's prior, 2 i for the step of index i, or of its posterior, 2 i + 1.
    What is kept grows with the size of what was reached, not with the number of the steps.
    """

    def __init__(self, probability: float, path: bool = False) -> None:
        """path : whether to keep the estimated position at every instant"""
        self._k = radius_factor(probability)
        self.known, self.true, self.ellipses, self.others = Box(), Box(), Box(), Box()
        self.all_true = True  # whether the truth is known at every step
        self.stages: list[tuple[int, Limits, Limits]] = []  # instant, `known` and `ellipses` by it
        self.last = -1  # instant
        self.path = array("d") if path else None  # x and y of the instants one after another
        self._kept = Limits(0.0, 0.0, 0.0, 0.0), Limits(0.0, 0.0, 0.0, 0.0)
        self._belief: Belief | None = None
        self._unplaced: Unplaced | None = None

    def take(self, step: Step) -> None:
        """Reach as far as the next step does."""
        entry, instant = step.entry, 2 * step.entry.index
        if entry.truth is None:
            self.all_true = False
        else:
            x, y, _ = entry.truth.tolist()
            self.known.hold(x, y)
            self.true.hold(x, y)
        if entry.fix is not None:
            self.others.hold(*entry.fix.tolist())
        if isinstance(entry.given, Reading):
            for x, y in _ends(step):
                self.others.hold(x, y)
        self._believe(step.prior, step, instant)
        self._believe(step.posterior, step, instant + 1)

    def _believe(self, belief: Belief, step: Step, instant: int) -> None:
        """Hold the estimated position, and the box about its ellipse."""
        if belief is not self._belief:
            self._belief = belief
            i, j = step.layout.position
            mean, P = belief
            x, y = float(mean[i]), float(mean[j])
            self.known.hold(x, y)
            if self._unplaced is None:
                self._unplaced = Unplaced(step.posterior, step.layout)
            if self._unplaced.at(belief):
                P = np.zeros_like(P)  # it has no ellipse
            variance_x, variance_y = float(P[i, i]), float(P[j, j])
            east = self._k * math.sqrt(variance_x) if variance_x > 0 else 0.0
            north = self._k * math.sqrt(variance_y) if variance_y > 0 else 0.0
            self.ellipses.hold(x - east, y - north)
            self.ellipses.hold(x + east, y + north)
        if self.path is not None:
            i, j = step.layout.position
            self.path.extend((float(belief.mean[i]), float(belief.mean[j])))
        self.last = instant
        known, ellipses = self._kept
        if self.stages and self.known.within(known) and self.ellipses.within(ellipses):
            return
        held = self.known.limits, self.ellipses.limits
        if held[0] is not None and held[1] is not None:
            self._kept = held[0].grown(FINE * held[0].size), held[1].grown(FINE * held[1].size)
            self.stages.append((instant, *self._kept))


def _ends(step: Step) -> Iterator[list[float]]:
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
