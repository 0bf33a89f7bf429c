"""Tally → numbers that carry their uncertainty: shares with Wilson's interval, means with the band
of χ².
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Self

from ekfsim.filters.arithmetic.chi_square import band
from ekfsim.scene import Scene
from ekfsim.study.plan import Case
from ekfsim.study.tally import Tally

Z = 1.959963984540054  # of the 95 % interval


class Share(NamedTuple):
    """A share of some runs, with its 95 % interval (Wilson 1927): right also for shares near 0 and
    1, and few runs.

    >>> share = Share(2, 1000)
    >>> [round(number, 4) for number in (share.value, share.low, share.high)]
    [0.002, 0.0005, 0.0073]
    """

    runs: int
    of: int

    @property
    def value(self) -> float:
        """nan where there are no runs."""
        return self.runs / self.of if self.of else math.nan

    @property
    def low(self) -> float:
        """(p + z²/2n − z √(p(1 − p)/n + z²/4n²)) / (1 + z²/n)"""
        return max(self._centre - self._half, 0.0) if self.runs else self._none

    @property
    def high(self) -> float:
        """The same with a plus."""
        return min(self._centre + self._half, 1.0) if self.runs < self.of else self.value

    @property
    def _none(self) -> float:
        return 0.0 if self.of else math.nan

    @property
    def _centre(self) -> float:
        n, p = self.of, self.value
        return (p + Z * Z / (2 * n)) / (1 + Z * Z / n) if n else math.nan

    @property
    def _half(self) -> float:
        n, p = self.of, self.value
        return (
            Z * math.sqrt(p * (1 - p) / n + (Z / (2 * n)) ** 2) / (1 + Z * Z / n) if n else math.nan
        )


class Mean(NamedTuple):
    """A mean of χ² variables, and the two-sided 95 % band that it lies in where all is as the
    filter says.
    """

    value: float
    low: float
    high: float

    @classmethod
    def of(cls, total: float, dof: int, n: int) -> "Mean":
        """The mean of n of them that together have `dof` degrees of freedom; nan where there is
        none.
        """
        if n == 0:
            return cls(math.nan, math.nan, math.nan)
        low, high = band(0.95, dof)
        return cls(total / n, low / n, high / n)


class AtStep(NamedTuple):
    """What is said of one step of all runs."""

    step: int
    t: float  # s; nan where there is no clock
    runs: int
    impossible: int
    position_rmse: float  # m
    heading_rmse: float  # rad
    above_50: Share
    above_95: Share
    above_999: Share
    ellipse: Share  # inside it
    cone: Share
    lost: Share  # from this step or an earlier one to the end
    nees: Mean


@dataclass(frozen=True)
class Result:
    """What is said of all runs of a case."""

    case: Case
    tally: Tally

    @classmethod
    def alone(cls, scene: Scene, tally: Tally) -> Self:
        """Of runs of one scene, which no study sweeps."""
        return cls(Case((), scene), tally)

    @cached_property
    def steps(self) -> tuple[AtStep, ...]:
        """Every step that is told of."""
        return tuple(map(self._at, range(len(self.tally.steps))))

    @property
    def last(self) -> AtStep:
        """The end of the runs."""
        return self.steps[-1]

    @property
    def nis(self) -> Mean:
        """NIS of all readings of all runs, per degree of freedom."""
        return Mean.of(self.tally.of.nis_sum, self.tally.of.nis_dof, self.tally.of.nis_dof)

    @property
    def lost_from(self) -> int | None:
        """The median step from which on the lost runs are lost; None where none is."""
        lost = self.tally.lost_from
        return _middle(lost) if lost else None

    @property
    def worst(self) -> int:
        """The number of the run that ended worst."""
        return self.tally.worst.run

    @property
    def typical(self) -> int:
        """The number of a run whose last NEES is the median of all, but for 2 %."""
        spread = self.tally.spread
        return spread[_middle({key: held.runs for key, held in spread.items()})].lowest

    def time_of(self, step: int | None) -> float:
        """The instant of a step in s, to the nearest that is told of; nan where there is no
        clock.
        """
        if step is None:
            return math.nan
        at = int(abs(self.tally.steps - step).argmin())
        return float(self.tally.times[at])

    def _at(self, k: int) -> AtStep:
        at, runs, step = self.tally.at, self.tally.runs, int(self.tally.steps[k])
        judged = int(at.judged[k])
        lost = sum(n for first, n in self.tally.lost_from.items() if first <= step)
        return AtStep(
            step,
            float(self.tally.times[k]),
            runs,
            int(at.impossible[k]),
            math.sqrt(at.position_square[k] / runs),
            math.sqrt(at.heading_square[k] / runs),
            Share(int(at.above_50[k]), judged),
            Share(int(at.above_95[k]), judged),
            Share(int(at.above_999[k]), judged),
            Share(int(at.in_ellipse[k]), int(at.ellipse_runs[k])),
            Share(int(at.in_cone[k]), int(at.cone_runs[k])),
            Share(lost, runs),
            Mean.of(float(at.nees_sum[k]), int(at.nees_dof[k]), int(at.nees_runs[k])),
        )


def _middle(counts: Mapping[int, int]) -> int:
    """The median of whole numbers that are there so many times; of two in the middle the lower."""
    before, half = 0, (sum(counts.values()) + 1) // 2
    for key in sorted(counts):
        before += counts[key]
        if before >= half:
            return key
    raise AssertionError("no counts")
