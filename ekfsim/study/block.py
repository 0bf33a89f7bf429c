"""1024 runs side by side → a Tally. They are the unit of work: the runs of a block share their
draws.
"""

import functools
import math
import operator
from typing import NamedTuple

import numpy as np

from ekfsim.commands import expanded_length
from ekfsim.diagnostics.nees import error
from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.belief import Correction, posed
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.localization import play
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.study.counting import (
    SIDES,
    Judged,
    bounds,
    coverage_counts,
    covered,
    error_squares,
    nees_counts,
    nees_sums,
    spread,
)
from ekfsim.study.tally import AtSteps, Extreme, OfRuns, Tally, dtype_of
from ekfsim.twins import Way, taken, taking, twinned

MOST_PARTICLES = 2_000_000  # of all runs that are watched at once: they take some 400 bytes each
MOST_STEPS = 1000  # of a longer run so many are told of, evenly spaced, and the last


class Ends(NamedTuple):
    """How each of N runs ended : (N,) each"""

    lost: Booleans
    inside: Booleans  # the truth is inside the ellipse
    drawn: Booleans  # the ellipse has an area
    position: Array  # m, from the truth to the estimate
    heading: Array  # rad, without its sign


def run_block(scene: Scene, first: int, runs: int, way: Way | None = None) -> Tally:
    """What becomes of the runs first … first + runs − 1 of a scene.

    way : of twins.py; None: as all else in this process
    """
    with taking(way or taken()):
        return functools.reduce(
            operator.add, (tally_of(scene, *some) for some in at_once(scene, first, runs))
        )


@twinned
def tally_of(scene: Scene, first: int, runs: int) -> Tally:
    """The same, all of them side by side."""
    return watched(scene, first, runs).tally()


def at_once(scene: Scene, first: int, runs: int) -> list[tuple[int, int]]:
    """The runs first … first + runs − 1 in portions that fit the memory, each its first and how
    many.

    Only of particles there may be too many for a block's runs to be watched side by side.
    """
    some = max(MOST_PARTICLES // scene.tuning.particles, 1) if scene.filter == "pf" else runs
    return [(run, min(some, first + runs - run)) for run in range(first, first + runs, some)]


def watched(scene: Scene, first: int, runs: int) -> "Watch":
    """These runs, each told apart at its end."""
    watch = Watch(scene, np.arange(first, first + runs))
    before: Step | None = None
    for step in play(scene, watch.numbers):
        if before is not None and (step.entry.t is None or step.entry.t != before.entry.t):
            watch.judge(before)  # with a clock, once nothing more comes of that instant
        if step.correction is not None:
            watch.weigh(step.correction)
        before = step
    assert before is not None
    watch.judge(before)
    return watch


def length_of(scene: Scene) -> int:
    """How many steps a run has after its start; with a clock, how many instants."""
    if scene.drive is None:
        return expanded_length(scene.commands)
    assert scene.world.robot is not None
    return len(scene.drive.course(1 / scene.world.robot.rate).speed)


def steps_told(length: int) -> Integers:
    """Which steps of a run are told of : (k,)

    >>> steps_told(3).tolist(), len(steps_told(54900)), int(steps_told(54900)[-1])
    ([0, 1, 2, 3], 1001, 54900)
    """
    return np.round(np.linspace(0, length, min(length, MOST_STEPS) + 1)).astype(np.int64)


class Watch:
    """Watches N runs side by side, a step at a time."""

    def __init__(self, scene: Scene, numbers: Integers) -> None:
        self.numbers = numbers
        self._layout = scene.world.layout
        self._told = steps_told(length_of(scene)).tolist()
        self._step = -1
        self._times: list[float] = []
        self._rows: list[tuple[float, ...]] = []
        self._lost_from = np.full(numbers.shape, -1)
        self._nis, self._nis_dof = np.zeros(numbers.shape), np.zeros(numbers.shape, np.int64)
        self._readings = self._unsettled = 0
        self._last: Judged | None = None
        self._ended: Step | None = None

    def weigh(self, correction: Correction) -> None:
        """Take the NIS of a reading into account, refused or not."""
        known = ~np.isnan(correction.nis)
        self._nis += np.where(known, correction.nis, 0.0)
        self._nis_dof += known * correction.innovation.shape[-1]
        self._readings += int(np.count_nonzero(known))
        self._unsettled += int(np.count_nonzero(~np.asarray(correction.settled)))

    def judge(self, step: Step) -> None:
        """Hold the beliefs after a step against the truth."""
        self._step += 1
        self._ended = step
        now = self._last = Judged.of(step, self.numbers.shape)
        since = np.where(self._lost_from < 0, self._step, self._lost_from)
        self._lost_from = np.where(now.above(LOST), since, -1)
        if self._step == self._told[len(self._rows)]:
            pose, truth = posed(step.posterior, self._layout), step.entry.truth
            assert truth is not None
            counted = (
                nees_counts(now),
                coverage_counts(pose, truth),
                nees_sums(now),
                error_squares(pose, truth),
            )
            self._rows.append(sum(counted, ()))
            self._times.append(math.nan if step.entry.t is None else step.entry.t)

    def ends(self) -> Ends:
        """How each run ended."""
        assert self._ended is not None
        assert self._ended.entry.truth is not None
        assert self._last is not None
        pose = posed(self._ended.posterior, self._layout)
        e = error(pose, self._ended.entry.truth)
        return Ends(
            self._last.above(LOST),
            *covered(e, pose.covariance),
            np.hypot(e[..., 0], e[..., 1]),
            abs(e[..., 2]),
        )

    def tally(self) -> Tally:
        """What is left when the runs are over."""
        assert self._last is not None
        assert self._step == self._told[-1]
        columns = zip(AtSteps._fields, zip(*self._rows, strict=True), strict=True)
        steps, runs = np.unique(self._lost_from[self._lost_from >= 0], return_counts=True)
        return Tally(
            len(self.numbers),
            np.array(self._told),
            np.array(self._times),
            AtSteps._make(np.array(column, dtype_of(name)) for name, column in columns),
            self._of_runs(self._last),
            dict(zip(steps.tolist(), runs.tolist(), strict=True)),
            spread(self._last, self.numbers),
            self._worst(self._last),
        )

    def _of_runs(self, last: Judged) -> OfRuns:
        low, high = SIDES
        return OfRuns(
            nis_runs=int(np.count_nonzero(self._nis_dof)),
            nis_above=int(np.count_nonzero(self._nis > bounds(high, self._nis_dof))),
            nis_below=int(np.count_nonzero(self._nis < bounds(low, self._nis_dof))),
            nis_readings=self._readings,
            nis_dof=int(np.sum(self._nis_dof)),
            nis_sum=float(np.sum(self._nis)),
            nees_above=int(np.count_nonzero(last.above(high))),
            nees_below=int(np.count_nonzero(last.below(low))),
            unsettled=self._unsettled,
        )

    def _worst(self, last: Judged) -> Extreme:
        """The run that ended worst, of equals the lowest number."""
        i = int(np.argmax(np.where(last.impossible, np.inf, last.value)))
        impossible = bool(last.impossible[i])
        return Extreme(
            impossible, 0.0 if impossible else float(last.value[i]), int(self.numbers[i])
        )
