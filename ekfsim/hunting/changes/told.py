"""The smallest change of one told number that brings a filter down: the commands and the truth stay
as they are.

All of them go away from what is true step by step, up and down, each until enough runs do what is
wanted; between its last two steps the edge is halved a few times.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ekfsim.hunting.changes.variants import AXES, RATIOS, Told
from ekfsim.hunting.crew import Judge
from ekfsim.hunting.goals import Count
from ekfsim.hunting.shrinking import RUNS
from ekfsim.hunting.worlds import plain_of, with_world
from ekfsim.scene import Scene

STEP, STEPS = 1.2, 26  # of a factor: up to a hundredfold
LEAST = {"x": 0.05, "y": 0.05, "theta": 1.0}  # m, m, degrees: the first step of a start
HALVINGS = 3
DIGITS = 3


@dataclass(frozen=True)
class Needed:
    """How far a number is to be off."""

    told: Told
    true: float  # in the file's unit
    count: Count

    @property
    def factor(self) -> float:
        """Of a ratio, 1 or more; inf of a start, whose change is no factor."""
        if self.told.key.startswith("start"):
            return float("inf")
        one, other = sorted((self.told.value, self.true))
        return other / one


class Way(NamedTuple):
    """A told number in one direction."""

    key: str
    true: float  # in the file's unit
    values: list[float]  # farther and farther from it


def needed(scene: Scene, judge: Judge, enough: float) -> Iterator[Needed | None]:
    """Each told number that can do it, in either direction, by the smallest change of it; None
    after each step away from what is true.
    """
    waiting = list(_numbers(scene))
    for k in range(STEPS):
        waiting = [one for one in waiting if k < len(one.values)]
        steps = [Told(one.key, one.values[k]) for one in waiting]
        counts = judge(scene, steps, 0, RUNS)
        does = [count.share >= enough for count in counts]
        for one, step, count, yes in zip(waiting, steps, counts, does, strict=True):
            if yes:
                before = one.values[k - 1] if k else one.true
                yield _edge(scene, judge, enough, before, Needed(step, one.true, count))
        yield None
        waiting = [one for one, yes in zip(waiting, does, strict=True) if not yes]


def _edge(scene: Scene, judge: Judge, enough: float, before: float, found: Needed) -> Needed:
    """The edge between a number that does not do it and one that does, halved a few times."""
    key = found.told.key
    for _ in range(HALVINGS):
        middle = _told((before + found.told.value) / 2)
        (count,) = judge(scene, [Told(key, middle)], 0, RUNS)
        if count.share >= enough:
            found = Needed(Told(key, middle), found.true, count)
        else:
            before = middle
    return found


def _numbers(scene: Scene) -> Iterator[Way]:
    """Each told number, up and down."""
    noise = scene.world.noise
    for name, field in RATIOS.items():
        true = float(getattr(noise, field))
        if true > 0:
            for way in (1, -1):
                steps = [_told(true * STEP ** (way * k)) for k in range(1, STEPS)]
                yield Way(f"noise.{name}", true, steps)
    if scene.world.told.start_unknown:
        return
    for axis, true in zip(AXES, scene.world.start.tolist(), strict=True):
        true = float(np.degrees(true)) if axis == "theta" else true
        for way in (1, -1):
            offsets = [way * LEAST[axis] * 1.3**k for k in range(16)]
            values = [_told(true + offset) for offset in offsets]
            yield Way(f"start.{axis}", true, values)


def _told(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def untruly(scene: Scene, told: Told) -> Scene | None:
    """The scene whose filter is told so, in a world that a file can hold."""
    plain = plain_of(scene.world)
    if plain is None:
        return None
    section, name = told.key.split(".")
    belief = {**plain.get("belief", {})}
    if section == "start":  # all of it is told, or none
        start = scene.world.told.start
        true = {"x": float(start[0]), "y": float(start[1]), "theta": float(np.degrees(start[2]))}
        belief["start"] = {**true, **belief.get("start", {}), name: told.value}
    else:
        belief["noise"] = {**belief.get("noise", {}), name: told.value}
    return with_world(scene, {**plain, "belief": belief})
