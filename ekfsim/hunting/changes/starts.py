"""Starts from which the same commands bring a filter down: places where a robot can stand, and from
which it could do what it is asked to, were there no noise.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.commands import Command, Move, expand
from ekfsim.hunting.changes.lists import CLEAR, free_way
from ekfsim.hunting.changes.variants import Started, Variant
from ekfsim.hunting.crew import Judge
from ekfsim.hunting.goals import Count
from ekfsim.hunting.shrinking import RUNS
from ekfsim.hunting.worlds import plain_of, with_world
from ekfsim.scene import Scene
from ekfsim.study.results import Share
from ekfsim.world import World

TRIES = 300  # for a place to stand
PER_METRE, FINE = 10, 5  # steps of x and y, degrees of a heading
METRES, DEGREES = (1.0, 0.5, 0.25), (90, 45, 30, 15, 10)  # that are rounder, the roundest first


@dataclass(frozen=True)
class Starts:
    """The starts that are looked through."""

    world: World
    commands: Sequence[Command]

    def by_chance(self, rng: np.random.Generator) -> Started:
        """Anywhere in the room."""
        low, high = self.world.map.walls.boxes
        low, high = low.min(axis=0), high.max(axis=0)
        for _ in range(TRIES):
            x, y = np.round(rng.uniform(low, high) * PER_METRE) / PER_METRE
            one = Started(float(x), float(y), math.radians(FINE * int(rng.integers(-35, 37))))
            if self.suits(one):
                return one
        return Started(*self.world.start.tolist())

    def changed(self, one: Variant, rng: np.random.Generator) -> Started:
        """Near another."""
        assert isinstance(one, Started)
        x, y = (v + int(rng.integers(-4, 5)) / PER_METRE for v in (one.x, one.y))
        turned = round(math.degrees(one.theta)) + int(rng.integers(-20, 21))
        near = Started(round(x, 2), round(y, 2), math.radians((turned + 179) % 360 - 179))
        return near if self.suits(near) else self.by_chance(rng)

    def crossed(self, one: Variant, other: Variant, rng: np.random.Generator) -> Started:
        """The place of one, the heading of another."""
        assert isinstance(one, Started)
        assert isinstance(other, Started)
        both = replace(one, theta=other.theta)
        return both if self.suits(both) else self.by_chance(rng)

    def suits(self, one: Started) -> bool:
        """Whether a robot can stand there, and no wall is in its way."""
        from shapely import LineString, Point  # slow to import

        boundary, obstacles = self.world.map.areas
        place = Point(one.x, one.y)
        if any(LineString(line.points).distance(place) < CLEAR for line in self.world.map.lines):
            return False
        if boundary is not None and not boundary.buffer(-CLEAR).contains(place):
            return False
        if any(area.distance(place) < CLEAR for area in obstacles):
            return False
        x, y, θ = one.x, one.y, one.theta
        for command in expand(self.commands):
            if isinstance(command, Move):
                if free_way(self.world.map.walls, x, y, θ, command.distance) != command.distance:
                    return False
                x, y = x + command.distance * math.cos(θ), y + command.distance * math.sin(θ)
                θ += command.angle
        return True


def rounder(scene: Scene, starts: Starts, best: Started, judge: Judge) -> tuple[Started, Count]:
    """The same start in rounder numbers, while the share stays in its interval."""
    (before,) = judge(scene, [best], 0, RUNS)
    low, count = Share(*before).low, before
    for axis in ("x", "y", "theta"):
        tried = [one for one in _rounder(best, axis) if starts.suits(one)]
        for one, found in zip(tried, judge(scene, tried, 0, RUNS), strict=True):
            if found.share >= low:
                best, count = one, found
                break
    return best, count


def _rounder(one: Started, axis: str) -> Iterator[Started]:
    if axis == "theta":
        degrees = math.degrees(one.theta)
        for turn in DEGREES:
            yield replace(one, theta=math.radians(turn * round(degrees / turn)))
        return
    for step in METRES:
        yield replace(one, **{axis: step * round(getattr(one, axis) / step)})


def begun(scene: Scene, one: Started) -> Scene | None:
    """The scene begun there, in a world that a file can hold; None where its file tells the filter
    of a start of its own.
    """
    plain = plain_of(scene.world)
    if plain is None or "start" in plain.get("belief", {}):
        return None
    place = {"x": one.x, "y": one.y, "theta": round(math.degrees(one.theta), 6)}
    return with_world(scene, {**plain, "start": {**plain.get("start", {}), **place}})
