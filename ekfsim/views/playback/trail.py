"""The ways of a run, as they grow from view to view."""

import math
from array import array
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from ekfsim.commands import Kidnap
from ekfsim.filters.belief import Particles
from ekfsim.geometry import Array
from ekfsim.records import Control, Step


class Trail:
    """Positions one after another, in m. It only ever grows, so that all views share one."""

    def __init__(self) -> None:
        self._numbers = array("d")

    def __len__(self) -> int:
        return len(self._numbers) // 2

    def append(self, x: float, y: float) -> None:
        """One position more."""
        self._numbers.append(x)
        self._numbers.append(y)

    def break_off(self) -> None:
        """What comes next is not reached from what was: a row of nan, which no line crosses."""
        if self._numbers and not math.isnan(self._numbers[-1]):
            self.append(math.nan, math.nan)

    def until(self, n: int) -> Array:
        """The first n positions : (n, 2) m"""
        return np.array(self._numbers[: 2 * n]).reshape(-1, 2)


@dataclass(frozen=True, slots=True)
class Way:
    """A trail as far as it goes in one view."""

    trail: Trail = field(default_factory=Trail)
    n: int = 0

    @classmethod
    def now(cls, trail: Trail) -> Self:
        """As far as the trail goes by now."""
        return cls(trail, len(trail))

    def points(self) -> Array:
        """Its positions; a row of nan where it is broken : (n, 2) m"""
        return self.trail.until(self.n)


class Ways:
    """Where the robot truly was, and where it would be by its odometry alone."""

    def __init__(self) -> None:
        self.true, self.reckoned = Trail(), Trail()
        self._reckoned: Array | None = None  # (n,), the whole state

    def take(self, step: Step) -> None:
        """Follow one more step; the first is the start."""
        entry = step.entry
        if self._reckoned is None:
            x = step.posterior.mean
            nowhere = isinstance(step.posterior, Particles)  # all over the floor
            self._reckoned = np.full_like(x, np.nan) if nowhere else x
        elif isinstance(entry.given, Control):
            self._reckoned = entry.given.motion.f(self._reckoned, entry.given.u)
        if isinstance(entry.command, Kidnap):
            self.true.break_off()

    def mark(self, step: Step) -> None:
        """Keep where both are at this step, which is shown."""
        if step.entry.truth is None:
            self.true.break_off()
        else:
            x, y, _ = step.entry.truth.tolist()
            self.true.append(x, y)
        assert self._reckoned is not None
        x, y, _ = step.layout.pose(self._reckoned).tolist()
        self.reckoned.append(x, y)
