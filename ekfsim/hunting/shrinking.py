"""Fewer commands, fewer obstacles, rounder numbers, while as many runs do what is wanted.

As many: the share of runs stays surely above what is enough, or where nothing is said of that, or
less is found, above the low end of the interval that it has before anything is left out.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from ekfsim.commands import Command, Move, Sense
from ekfsim.hunting.changes.lists import Doing, Listed, Space
from ekfsim.hunting.changes.variants import Commanded
from ekfsim.hunting.crew import Judge
from ekfsim.hunting.goals import Count
from ekfsim.scene import Scene
from ekfsim.study.results import Share

RUNS = 1024  # behind every share
METRES = 1.0, 0.5, 0.25, 0.1, 0.05  # that a way may be a multiple of, the roundest first
DEGREES = 90, 45, 30, 15, 10, 5, 1

Barred = Callable[[Scene, str], Scene | None]  # a scene without an obstacle; None: it is no scene
# the first of some lists that does it in a scene; None where none does
Enough = Callable[[Scene, Sequence[Listed]], Listed | None]


@dataclass(frozen=True)
class Shrunk:
    """What is left of a scene and its list."""

    scene: Scene
    listed: tuple[Command, ...]
    count: Count
    whole: bool  # whether all was tried that may be left out


def shrunk(
    scene: Scene, space: Space, listed: Listed, judge: Judge, least: float | None,
    without: Barred, go_on: Callable[[], bool],
) -> Shrunk:  # fmt: skip
    """The scene with what is left of its obstacles, and what is left of a list.

    least : the share that is enough; without : how an obstacle is taken away; go_on : whether there
    is time for more
    """
    (before,) = judge(scene, [Commanded(listed)], 0, RUNS)
    low = Share(*before).low

    def holds(count: Count) -> bool:
        if least is not None and least <= low:
            return Share(*count).low >= least
        return count.share >= low

    def enough(scene: Scene, tried: Sequence[Listed]) -> Listed | None:
        if not tried or not go_on():
            return None
        counts = judge(scene, [Commanded(one) for one in tried], 0, RUNS)
        return next((one for one, c in zip(tried, counts, strict=True) if holds(c)), None)

    scene, listed = less(scene, space, listed, enough, without)
    whole = go_on()
    (count,) = judge(scene, [Commanded(listed)], 0, RUNS)
    return Shrunk(scene, listed, count, whole)


def less(
    scene: Scene, space: Space, listed: Listed, enough: Enough, without: Barred
) -> tuple[Scene, Listed]:
    """What is left of obstacles and commands, whatever is enough."""
    listed = _fewer(space, scene, listed, enough)
    for obstacle in scene.world.map.obstacles:
        barer = without(scene, obstacle.name)
        if barer is not None and enough(barer, [listed]):
            scene = barer
    space = replace(space, world=scene.world)
    return scene, _fewer(space, scene, _rounder(space, scene, listed, enough), enough)


def _fewer(space: Space, scene: Scene, listed: Listed, enough: Enough) -> Listed:
    """As few commands as do it: each left out alone, until none can be."""
    while len(listed) > 1:
        tried = [(*listed[:i], *listed[i + 1 :]) for i in range(len(listed))]
        found = enough(scene, [one for one in tried if space.mended(one) == one])
        if found is None:
            return listed
        listed = found
    return listed


def _rounder(space: Space, scene: Scene, listed: Listed, enough: Enough) -> Listed:
    """Every number as round as it may be, one after the other."""
    for i, command in enumerate(listed):
        for round_one in (_rounder_ways, _rounder_angles):
            tried = [(*listed[:i], one, *listed[i + 1 :]) for one in round_one(command)]
            tried = [one for one in tried if space.mended(one) == one]
            found = enough(scene, tried)
            if found is not None:
                listed, command = found, found[i]
    return listed


def _rounder_ways(command: Doing) -> Iterator[Doing]:
    """The same move with a rounder way, the roundest first, that it has already left out."""
    if isinstance(command, Sense) or command.distance == 0:
        return
    yield Move(0.0, command.angle)
    for step in METRES:
        way = round(round(command.distance / step) * step, 2)
        if way == command.distance:
            return
        if way:
            yield Move(way, command.angle)


def _rounder_angles(command: Doing) -> Iterator[Doing]:
    degrees = round(math.degrees(command.angle))
    if degrees == 0:
        return
    for step in (math.inf, *DEGREES):
        turn = 0 if math.isinf(step) else int(round(degrees / step) * step)
        if turn == degrees:
            return
        yield replace(command, angle=math.radians(turn))
