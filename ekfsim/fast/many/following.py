"""The instants of many runs judged by many at once, and no belief twice."""

import functools
from collections.abc import Iterable

import numpy as np

from ekfsim.diagnostics.verdict import LOST
from ekfsim.study.block import Instant, Readings, Watched, judge
from ekfsim.study.counting import by_rank

MOST = 64  # instants at once


def follow(so_far: Watched, moments: Iterable[Instant]) -> Watched:
    """Hold the beliefs of all instants against the truth: those that are not told of together."""
    untold, told = list[Instant](), None
    for now in moments:
        if so_far.step + len(untold) + 1 != so_far.told[len(so_far.at)]:
            untold.append(now)
            if len(untold) == MOST:
                so_far, untold = passed(so_far, untold), []
            continue
        if untold:
            so_far, untold, told = passed(so_far, untold), [], None
        so_far = again(so_far, now) if told and is_still(told, now) else judge(so_far, now)
        told = now
    return passed(so_far, untold) if untold else so_far


def is_still(before: Instant, now: Instant) -> bool:
    """Whether nothing happened since the instant before."""
    return before.nees is now.nees and before.truth is now.truth and not now.corrections


def again(so_far: Watched, now: Instant) -> Watched:
    """One more instant that is told of, at which nothing happened."""
    at, times = (*so_far.at, so_far.at[-1]), (*so_far.times, now.t)
    return so_far._replace(step=so_far.step + 1, at=at, times=times)


def passed(so_far: Watched, untold: list[Instant]) -> Watched:
    """Some more instants that are not told of: what is asked is who is lost."""
    measured = [now.nees for now in untold]
    each = np.zeros(so_far.numbers.shape, np.int64)  # where P is the same for all runs, so is dof
    rank = np.array([nees.dof + each for nees in measured])
    above = np.array([nees.value for nees in measured]) > by_rank(LOST)[rank]
    above |= np.array([nees.impossible for nees in measured])
    above |= ~np.isfinite([now.belief.mean for now in untold]).all(axis=-1)
    since = np.where(so_far.lost_from < 0, so_far.step + 1, so_far.lost_from)
    step = so_far.step + len(untold)
    at_last = np.argmin(above[::-1], axis=0)  # for how many instants without a gap
    return so_far._replace(
        step=step,
        lost_from=np.where(above.all(axis=0), since, np.where(at_last > 0, step - at_last + 1, -1)),
        readings=functools.reduce(
            Readings.add, (one for now in untold for one in now.corrections), so_far.readings
        ),
    )
