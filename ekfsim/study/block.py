"""1024 runs side by side → a Tally. They are the unit of work: the runs of a block share their
draws.

A block is a fold: the instants of its runs, one after another, into what is known of each run so
far; of that its tally is what remains at the end.
"""

import functools
import itertools
import math
import operator
from collections.abc import Iterable, Iterator
from typing import NamedTuple, Self

import numpy as np

from ekfsim.commands import expanded_length
from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.belief import Belief, Correction, posed
from ekfsim.filters.place import forward, is_smoothed
from ekfsim.filters.tuning import CROWDS
from ekfsim.geometry import Array, Integers
from ekfsim.localization import play
from ekfsim.models.layout import Layout
from ekfsim.records import Nees, Step
from ekfsim.scene import Scene
from ekfsim.simulation.draws import BLOCK
from ekfsim.study.counting import SIDES, Ends, Judged, bounds, counted, spread, worst
from ekfsim.study.tally import AtSteps, OfRuns, Tally, dtype_of
from ekfsim.twins import Way, taken, taking, twinned

MOST_PARTICLES = 2_000_000  # of all runs that are watched at once: they take some 400 bytes each
# of all steps and runs that are smoothed at once: entries of a covariance, at some 40 bytes each
MOST_KEPT = 16_000_000
MOST_STEPS = 1000  # of a longer run so many are told of, evenly spaced, and the last


def run_block(scene: Scene, first: int, runs: int, way: Way | None = None) -> Tally:
    """What becomes of the runs first … first + runs − 1 of a scene.

    way : of twins.py; None: as all else in this process
    """
    with taking(way or taken()):
        return functools.reduce(
            operator.add, (watched(scene, *some).tally() for some in at_once(scene, first, runs))
        )


def run_blocks(scene: Scene, runs: int) -> Tally:
    """What becomes of the runs 0 … runs − 1 of a scene, block after block."""
    return functools.reduce(
        operator.add,
        (run_block(scene, first, min(BLOCK, runs - first)) for first in range(0, runs, BLOCK)),
    )


def at_once(scene: Scene, first: int, runs: int) -> list[tuple[int, int]]:
    """The runs first … first + runs − 1 in portions that fit the memory, each its first and how
    many.

    Only of particles there may be too many for a block's runs to be watched side by side, and of
    steps that are kept until a run is over.
    """
    some = runs
    if forward(scene.filter) in CROWDS:
        some = max(MOST_PARTICLES // scene.tuning.crowd(scene.filter), 1)
    if is_smoothed(scene.filter):
        kept = (length_of(scene) + 1) * len(scene.world.layout.names) ** 2
        some = min(some, max(MOST_KEPT // kept, 1))
    return [(run, min(some, first + runs - run)) for run in range(first, first + runs, some)]


@twinned
def watched(scene: Scene, first: int, runs: int) -> "Watched":
    """The runs first … first + runs − 1, each told apart at its end."""
    numbers = np.arange(first, first + runs)
    return watched_along(scene, numbers, play(scene, numbers))


def watched_along(scene: Scene, numbers: Integers, steps: Iterable[Step]) -> "Watched":
    """The same of steps that N runs of a scene have, whoever filters them. numbers : (N,)"""
    start = Watched.empty(numbers, steps_told(length_of(scene)))
    return follow(start, instants(steps))


def length_of(scene: Scene) -> int:
    """How many steps a run has after its start; with a clock, how many instants."""
    if scene.drive is None or scene.world.robot is None:
        return expanded_length(scene.commands)
    return len(scene.drive.course(1 / scene.world.robot.rate).speed)


def steps_told(length: int) -> Integers:
    """Which steps of a run are told of : (k,)

    >>> steps_told(3).tolist(), len(steps_told(54900)), int(steps_told(54900)[-1])
    ([0, 1, 2, 3], 1001, 54900)
    """
    return np.round(np.linspace(0, length, min(length, MOST_STEPS) + 1)).astype(np.int64)


class Instant(NamedTuple):
    """What N runs believe once nothing more comes of an instant; without a clock every entry is
    one.
    """

    t: float  # s; nan where there is no clock
    belief: Belief
    layout: Layout
    truth: Array  # (N, 3)
    nees: Nees
    corrections: tuple[Correction, ...]  # by its readings, refused or not


def instants(steps: Iterable[Step]) -> Iterator[Instant]:
    """The steps of runs whose truth is known, instant by instant."""
    for _, together in itertools.groupby(steps, key=moment):
        *earlier, last = together
        entry = last.entry
        if entry.truth is not None and last.nees is not None:
            t = math.nan if entry.t is None else entry.t
            readings = (step.correction for step in (*earlier, last))
            corrections = tuple(one for one in readings if one is not None)
            yield Instant(t, last.posterior, last.layout, entry.truth, last.nees, corrections)


def moment(step: Step) -> float:
    """What steps of one instant have in common; without a clock each has its own."""
    return step.entry.index if step.entry.t is None else step.entry.t


class Readings(NamedTuple):
    """The readings of N runs so far."""

    nis: Array  # (N,) ΣNIS of each run, refused readings included
    dof: Integers  # (N,) its degrees of freedom
    number: int = 0  # in all runs together, of those that have a NIS
    unsettled: int = 0  # in all runs together: the search of an iterated filter was cut off

    def add(self, correction: Correction) -> Self:
        """One more reading in each run."""
        known = ~np.isnan(correction.nis)
        return self._replace(
            nis=self.nis + np.where(known, correction.nis, 0.0),
            dof=self.dof + known * correction.innovation.shape[-1],
            number=self.number + int(np.count_nonzero(known)),
            unsettled=self.unsettled + int(np.count_nonzero(~np.asarray(correction.settled))),
        )


class Watched(NamedTuple):
    """What is known of N runs up to an instant."""

    numbers: Integers  # (N,)
    told: Integers  # (k,) which steps are told of
    lost_from: Integers  # (N,) the step from which on a run is lost, −1 where it is not
    readings: Readings
    ends: Ends  # how each run stood at the last step that is told of
    step: int = -1
    at: tuple[AtSteps, ...] = ()  # of each step that was told of
    times: tuple[float, ...] = ()

    @classmethod
    def empty(cls, numbers: Integers, told: Integers) -> Self:
        """Runs that have not begun."""
        N = numbers.shape
        readings = Readings(np.zeros(N), np.zeros(N, np.int64))
        return cls(numbers, told, np.full(N, -1), readings, Ends.unknown(len(numbers)))

    def tally(self) -> Tally:
        """What is left when the runs are over."""
        steps, runs = np.unique(self.lost_from[self.lost_from >= 0], return_counts=True)
        columns = zip(AtSteps._fields, zip(*self.at, strict=True), strict=True)
        return Tally(
            runs=len(self.numbers),
            steps=self.told,
            times=np.array(self.times),
            at=AtSteps._make(np.array(column, dtype_of(name)) for name, column in columns),
            of=of_runs(self.readings, self.ends.nees),
            lost_from=dict(zip(steps.tolist(), runs.tolist(), strict=True)),
            spread=spread(self.ends.nees, self.numbers),
            worst=worst(self.ends.nees, self.numbers),
        )


@twinned
def follow(so_far: Watched, moments: Iterable[Instant]) -> Watched:
    """Hold the beliefs of one instant after another against the truth."""
    return functools.reduce(judge, moments, so_far)


def judge(so_far: Watched, now: Instant) -> Watched:
    """Hold the beliefs of one more instant against the truth."""
    step, nees = so_far.step + 1, Judged.of(now.nees, now.belief.mean)
    since = np.where(so_far.lost_from < 0, step, so_far.lost_from)
    after = so_far._replace(
        step=step,
        lost_from=np.where(nees.above(LOST), since, -1),
        readings=functools.reduce(Readings.add, now.corrections, so_far.readings),
    )
    if step != so_far.told[len(so_far.at)]:
        return after
    ends = Ends.of(nees, posed(now.belief, now.layout), now.truth)
    return after._replace(ends=ends, at=(*so_far.at, counted(ends)), times=(*so_far.times, now.t))


def of_runs(readings: Readings, last: Judged) -> OfRuns:
    """What is counted of runs that are over, by their readings and their last NEES."""
    low, high = SIDES
    return OfRuns(
        nis_runs=int(np.count_nonzero(readings.dof)),
        nis_above=int(np.count_nonzero(readings.nis > bounds(high, readings.dof))),
        nis_below=int(np.count_nonzero(readings.nis < bounds(low, readings.dof))),
        nis_readings=readings.number,
        nis_dof=int(np.sum(readings.dof)),
        nis_sum=float(np.sum(readings.nis)),
        nees_above=int(np.count_nonzero(last.above(high))),
        nees_below=int(np.count_nonzero(last.below(low))),
        unsettled=readings.unsettled,
    )
