"""What becomes of the same runs of a scenario under each cure: a column of a table for each.

A smoother believes at the last step what its filter does, and loses the same runs. So its column is
of all steps.
"""

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.place import SMOOTHED
from ekfsim.scene import Scene
from ekfsim.study.block import run_blocks
from ekfsim.study.results import Result, Share
from ekfsim.study.tally import Tally
from ekfsim.views.study.words import percent

PLAIN = "ekf"  # beside which the cures are held
CURES = tuple(
    name
    for name in ("huber", "pdaf", "mhekf", "amcl", "adaptive", "invariant")
    if name in FILTERS
)  # fmt: skip
HEAD = PLAIN, *CURES, "smoothed: steps beyond", "error"
NONE = "–"
RUNS, RUNS_OF_A_DRIVE = 200, 20  # of each filter; a drive takes long, and has no more than that
LEGEND = "✓ heals, ↓ fewer, ↑ more, ✗ kills"
MOST = 1 / 4  # of the runs that ekf loses, or keeps
MEANING = """\
How many runs in a hundred are lost as the scenario stands, under each filter, on the same draws. \
✓ heals: it loses at most a quarter of the runs that ekf loses. ✗ kills: it keeps at most a \
quarter of those that ekf keeps. ↓ fewer, ↑ more. No mark: their 95 % intervals (Wilson) meet, \
and chance may do as much. –: the filter cannot watch this scenario, for amcl needs a map with \
a boundary, and all others a start. A smoother loses the runs that its filter \
loses, for at the last step both are one; told of it are how many of all steps have a NEES \
beyond its χ² 99.9 % quantile, ekf → ekf-smoothed, and the error of position over all steps \
(RMSE), as a multiple of that of ekf."""


class Mark(StrEnum):
    """How a cure stands beside ekf."""

    HEALS = "✓"
    FEWER = "↓"
    NONE = ""
    MORE = "↑"
    KILLS = "✗"

    @classmethod
    def of(cls, cured: Share, plain: Share) -> "Mark":
        """The mark of a share of lost runs beside that of ekf.

        >>> [Mark.of(Share(n, 1000), Share(400, 1000)).value for n in (90, 300, 420, 500, 900)]
        ['✓', '↓', '', '↑', '✗']
        """
        if cured.high < plain.low:
            return cls.HEALS if cured.value <= MOST * plain.value else cls.FEWER
        if cured.low > plain.high:
            kept = 1 - cured.value, 1 - plain.value
            return cls.KILLS if kept[0] <= MOST * kept[1] else cls.MORE
        return cls.NONE


class AllSteps(NamedTuple):
    """How honest a filter is over all steps of all runs, and how near."""

    beyond: Share  # steps whose NEES is beyond its 99.9 % quantile
    position_rmse: float  # m

    @classmethod
    def of(cls, tally: Tally) -> "AllSteps":
        """Of the steps that a tally tells of."""
        at = tally.at
        square = np.sum(at.position_square) / (tally.runs * len(tally.steps))
        beyond = Share(int(np.sum(at.above_999)), int(np.sum(at.judged)))
        return cls(beyond, math.sqrt(square))


class Cured(NamedTuple):
    """A row of the table: what each filter makes of the same runs of a scenario."""

    runs: int
    lost: tuple[Share | None, ...]  # of ekf and each of CURES; None where it cannot watch
    steps: tuple[AllSteps, AllSteps] | None  # of ekf, and smoothed

    @property
    def marks(self) -> tuple[Mark, ...]:
        """How each share of `lost` stands beside that of ekf."""
        plain = self.lost[0]
        return tuple(
            Mark.NONE if plain is None or share is None else Mark.of(share, plain)
            for share in self.lost
        )

    @property
    def cells(self) -> tuple[str, ...]:
        """The cells beneath HEAD."""
        shares = (NONE if share is None else percent(share) for share in self.lost)
        marked = (f"{share} {mark}".strip() for share, mark in zip(shares, self.marks, strict=True))
        return *marked, *self._of_steps

    @property
    def _of_steps(self) -> tuple[str, str]:
        if self.steps is None:
            return NONE, NONE
        plain, smoothed = self.steps
        ratio = (
            f"× {smoothed.position_rmse / plain.position_rmse:.2g}" if plain.position_rmse else NONE
        )
        if not plain.beyond.of:
            return NONE, ratio
        return f"{percent(plain.beyond)} → {percent(smoothed.beyond)}", ratio


def cured(scene: Scene, most: int) -> Cured:
    """What becomes of `most` runs of a scene under each filter, of a drive of no more than
    RUNS_OF_A_DRIVE.
    """
    runs = most if scene.commanded else min(most, RUNS_OF_A_DRIVE)
    tallies = [watched_by(name, scene, runs) for name in (PLAIN, *CURES, PLAIN + SMOOTHED)]
    plain, *_, smoothed = tallies
    lost = (
        None if tally is None else Result.alone(scene, tally).last.lost for tally in tallies[:-1]
    )
    steps = (AllSteps.of(plain), AllSteps.of(smoothed)) if plain and smoothed else None
    return Cured(runs, tuple(lost), steps)


def watched_by(name: str, scene: Scene, runs: int) -> Tally | None:
    """What becomes of runs under the filter of that name; None where it cannot watch them."""
    try:
        return run_blocks(replace(scene, filter=name, beside=()), runs)
    except UsageError:
        return None


def whose(runs: Sequence[int]) -> str:
    """What the first column holds of scenarios that so many runs each were watched of.

    >>> whose([200, 200, 50]), whose([200])
    ('200 runs of each (50 of a drive)', '200 runs of each')
    """
    most = max(runs)
    fewer = "" if min(runs) == most else f" ({min(runs)} of a drive)"
    return f"{most} runs of each{fewer}"


def assumption(name: str) -> str:
    """What a cure assumes: the first line of its file."""
    told = sys.modules[FILTERS[name].__module__].__doc__ or ""
    return told.partition("\n")[0]
