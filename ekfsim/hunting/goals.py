"""What is wanted of many runs of a scene: each goal counts the runs that do it.

A run counts as lost where its NEES says so and its estimate is off by so much that people would
call it lost. Without that a hunt finds what no one would see: after a turn and a move without a
reading P is singular, and a truth that lies a hair beside its plane makes the belief impossible.
"""

import functools
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, Protocol, get_args

import numpy as np

from ekfsim.geometry import Booleans
from ekfsim.scene import Scene
from ekfsim.simulation.draws import BLOCK
from ekfsim.study.block import Watched, at_once, watched
from ekfsim.study.counting import SIDES, bounds

Name = Literal["lost", "silent", "apart"]
NAMES: tuple[Name, ...] = get_args(Name)


class Count(NamedTuple):
    """Of how many runs a goal holds."""

    hits: int
    of: int  # runs

    @property
    def share(self) -> float:
        """Of runs, at least one."""
        return self.hits / self.of

    def plus(self, other: "Count") -> "Count":
        """Of both."""
        return Count(self.hits + other.hits, self.of + other.of)


class Goal(Protocol):
    """What is wanted: the larger the count, the better the scene."""

    def __call__(self, scene: Scene, first: int, runs: int) -> Count:
        """Of how many of the runs first … first + runs − 1 it holds."""


@dataclass(frozen=True, slots=True)
class Lost:
    """As many runs lost at their end as may be."""

    off: float = 0.0  # m, how far a lost estimate is to lie from the truth

    def __call__(self, scene: Scene, first: int, runs: int) -> Count:
        """Runs whose last NEES lies beyond the 99.9 % quantile."""
        parts = (watched(scene, *some) for some in at_once(scene, first, runs))
        return Count(sum(int(np.count_nonzero(astray(part, self.off))) for part in parts), runs)


@dataclass(frozen=True, slots=True)
class Silent:
    """As many runs lost as may be that no one can tell by their readings."""

    off: float = 0.0  # m

    def __call__(self, scene: Scene, first: int, runs: int) -> Count:
        """Lost runs of which ΣNIS lies inside its two-sided 95 % band."""
        parts = (watched(scene, *some) for some in at_once(scene, first, runs))
        return Count(sum(int(np.count_nonzero(silent(part, self.off))) for part in parts), runs)


@dataclass(frozen=True, slots=True)
class Apart:
    """As many more runs lost under one filter than under another, on the same draws."""

    other: str  # the filter that is to keep its way
    off: float = 0.0  # m

    def __call__(self, scene: Scene, first: int, runs: int) -> Count:
        """Runs that the scene's filter loses and the other does not, less the reverse."""
        hits = 0
        for some in at_once(scene, first, runs):
            one = astray(watched(scene, *some), self.off)
            two = astray(watched(replace(scene, filter=self.other), *some), self.off)
            hits += int(np.count_nonzero(one & ~two)) - int(np.count_nonzero(two & ~one))
        return Count(max(hits, 0), runs)


def counted(goal: Goal, scene: Scene, runs: int) -> Count:
    """Of how many of the runs 0 … runs − 1 it holds, block after block."""
    blocks = (goal(scene, b, min(BLOCK, runs - b)) for b in range(0, runs, BLOCK))
    return functools.reduce(Count.plus, blocks)


def astray(runs: Watched, off: float) -> Booleans:
    """Which of N runs are lost, and off by more than that : (N,)

    Where an estimate is no number it is.
    """
    found: Booleans = runs.ends.lost & ~(runs.ends.position <= off)
    return found


def silent(runs: Watched, off: float = 0.0) -> Booleans:
    """Which of N runs are lost with a ΣNIS inside its band : (N,)"""
    low, high = SIDES
    nis, dof = runs.readings.nis, runs.readings.dof
    inside = (dof > 0) & (nis >= bounds(low, dof)) & (nis <= bounds(high, dof))
    found: Booleans = astray(runs, off) & inside
    return found
