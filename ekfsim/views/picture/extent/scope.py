"""How much of the plane each picture of a run shows: its world, and more from where on the estimate
or the truth has left it.

A view's limits follow from the run up to it, so that they are the same whichever way the view is
reached. They never shrink, for the path that was drawn stays; and they grow by much, so that they
grow seldom.
"""

import functools
import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ekfsim.geometry import Array
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.picture.extent.limits import LEAST, Limits
from ekfsim.views.picture.extent.reach import Reach
from ekfsim.views.playback.view import View
from ekfsim.world import World

MARGIN = 0.05  # of the longer side, all around: room for the robot's body and for names
# of a side: its margins at most, so that a corridor is not lost in them
ACROSS = 0.25
NARROWEST = 0.08  # of the longer side: the shorter one at least
# of the longer side: how far what lies just outside a room, or anywhere near what has no walls,
# is held from the first
NEAR, AROUND = 0.03, 0.5
STEP = 0.25  # of the longer side: by how much the limits grow at least, then twice that, …
FOLLOWED = 0.35  # of the sides: how much is shown where the picture follows the estimate
MIDDLE = 0.5  # of what is shown then: where the estimate moves without moving the picture


@dataclass(frozen=True, slots=True)
class Scope:
    """What each view shows. The stages are in order, each with its first instant (see `Reach`)."""

    base: Limits
    stages: tuple[tuple[int, Limits], ...] = ()
    last: float = math.inf  # the instant up to which they are known

    def at(self, view: View) -> Limits:
        """What a view shows."""
        instant = 2 * view.step.entry.index + (not view.beam)
        known = bisect_right(self.stages, instant, key=lambda stage: stage[0])
        limits = self.stages[known - 1][1] if known else self.base
        if instant <= self.last:
            return limits
        return limits.joined(widened(self.base, Limits.around(np.vstack(list(_ways(view))))))

    @property
    def whole(self) -> Limits:
        """All that any view shows."""
        return functools.reduce(Limits.joined, (limits for _, limits in self.stages), self.base)

    def joined(self, other: "Scope") -> "Scope":
        """What holds at every instant both."""
        stages: list[tuple[int, Limits]] = []
        for instant in sorted({first for each in (self, other) for first, _ in each.stages}):
            stages.append((instant, self._by(instant).joined(other._by(instant))))
        base = self.base.joined(other.base)
        return Scope(base, _changes(base, stages), min(self.last, other.last))

    def _by(self, instant: int) -> Limits:
        known = bisect_right(self.stages, instant, key=lambda stage: stage[0])
        return self.stages[known - 1][1] if known else self.base


def of(scene: Scene, steps: Iterable[Step], probability: float = 0.954) -> Scope:
    """What the pictures of a run show: the room of both maps, or, without walls, the surroundings
    of landmarks and truth, of the estimates where no truth is known. The steps are read once and
    none is kept.

    Ellipses are held where they are not much larger than all that: one that is must not shrink the
    world to a dot. So are recorded fixes and the ends of readings near by.
    """
    reach = Reach(probability)
    for step in steps:
        reach.take(step)
    base = _base(scene.world, reach)
    stages = []
    for instant, known, ellipses in reach.stages:
        whole = base.joined(known)
        whole = whole.joined(ellipses.cut(whole.grown(STEP * whole.size)))
        stages.append((instant, widened(base, whole)))
    return Scope(base, _changes(base, stages), reach.last)


def of_all(
    scene: Scene,
    runs: Iterable[Iterable[Step]],
    probability: float = 0.954,
    follow: bool = False,
) -> Scope:
    """The same for a run that several filters watch; or `following` the first of them."""
    first, *others = runs
    if follow:
        return following(scene, first, probability)
    each = (of(scene, steps, probability) for steps in (first, *others))
    return functools.reduce(Scope.joined, each)


def following(scene: Scene, steps: Iterable[Step], probability: float = 0.954) -> Scope:
    """A part of the same, always of one size, that goes with the estimate: it moves to have it in
    its middle when it comes near the edge.
    """
    reach = Reach(probability, path=True)
    for step in steps:
        reach.take(step)
    base, stages = _base(scene.world, reach), []
    assert reach.path is not None
    half = FOLLOWED / 2 * np.array([base.width, base.height])
    center = np.full(2, math.inf)
    for instant, place in enumerate(np.reshape(reach.path, (-1, 2))):
        if np.isfinite(place).all() and (np.abs(place - center) > MIDDLE * half).any():
            center = place
            stages.append((instant, Limits(*(center - half).tolist(), *(center + half).tolist())))
    return Scope(stages[0][1] if stages else base, tuple(stages))


def showing(part: Limits) -> Scope:
    """A part of the plane in every view; more of it beside a strip too narrow to be seen."""
    longer = max(part.width, part.height)
    narrow = min(part.width, part.height) < NARROWEST * longer
    return Scope(_broad(part, longer) if narrow else part)


def widened(base: Limits, reached: Limits) -> Limits:
    """The base, with each side that was passed moved out by STEP, or twice, four times … that."""
    step = STEP * base.size

    def beyond(excess: float) -> float:
        return 0.0 if excess <= 0 else step * 2.0 ** max(math.ceil(math.log2(excess / step)), 0)

    return Limits(
        base.left - beyond(base.left - reached.left),
        base.bottom - beyond(base.bottom - reached.bottom),
        base.right + beyond(reached.right - base.right),
        base.top + beyond(reached.top - base.top),
    )


def _base(world: World, reach: Reach) -> Limits:
    """What is shown from the first view on."""
    stands = list(_standing(world))
    core = Limits.around(np.vstack(stands)) if stands else None
    walls = any(floor.boundary is not None for floor in (world.map, world.told.map))
    if not walls or core is None:
        driven = (reach.true if reach.all_true else reach.known).limits
        core = core.joined(driven) if core and driven else core or driven
    core = core or Limits(0.0, 0.0, 1.0, 1.0)
    near = _grown(core, NEAR) if walls else core.grown(AROUND * core.size)
    for box in (reach.known, reach.ellipses, reach.others):
        held = box.limits
        if held is not None and (core.size <= LEAST or held.meets(near)):
            core = core.joined(held if core.size <= LEAST else held.cut(near))
    return _grown(_broad(core, core.size), MARGIN)


def _broad(limits: Limits, longer: float) -> Limits:
    """With a shorter side that is still seen beside the longer one."""
    width, height = (max(side, NARROWEST * longer) for side in (limits.width, limits.height))
    x, y = (limits.left + limits.right) / 2, (limits.bottom + limits.top) / 2
    return Limits(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def _grown(limits: Limits, share: float) -> Limits:
    """With a share of the longer side more on every side, but not with much more than it has."""
    sides = limits.width, limits.height
    x, y = (share * min(limits.size, ACROSS / MARGIN * side) for side in sides)
    return Limits(limits.left - x, limits.bottom - y, limits.right + x, limits.top + y)


def _changes(base: Limits, stages: Iterable[tuple[int, Limits]]) -> tuple[tuple[int, Limits], ...]:
    """Those that differ from what holds before them."""
    each = [(-1, base), *stages]
    return tuple(now for before, now in pairwise(each) if now[1] != before[1])


def _ways(view: View) -> Iterator[Array]:
    """All that the filters believed of the position, and where it truly was : (n, 2) m each"""
    for each in (view, *view.others):
        yield each.path()
        yield each.true.points()
        if each.step.entry.truth is not None:
            yield each.step.entry.truth[None, :2]


def _standing(world: World) -> Iterator[Array]:
    """Everything that stands in either map : (n, 2) m each"""
    for floor in (world.map, world.told.map):
        for _, line in floor.outlines():
            yield line
    for landmark in world.landmarks:
        yield np.array([[landmark.x, landmark.y]])
    if world.expected_path is not None:
        yield world.expected_path
