"""The summary of a driven robot's run, many motion inputs at once."""

from collections.abc import Iterable, Iterator
from itertools import groupby

import numpy as np

from ekfsim.diagnostics.nees import error
from ekfsim.diagnostics.summary import Errors, Summary
from ekfsim.diagnostics.verdict import LOST
from ekfsim.fast.many_steps import moved
from ekfsim.fast.stretches import FEW, is_planar
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.outline import path_error
from ekfsim.models.protocols import Motion
from ekfsim.records import Control, Step

PORTION = 512  # steps that are taken into account together


def following(summary: Summary, steps: Iterable[Step]) -> Iterator[Step] | None:
    """The same steps, all of them taken into account at the end. None where a state is no pose."""
    return _following(summary, steps) if summary.layout.is_pose else None


def _following(summary: Summary, steps: Iterable[Step]) -> Iterator[Step]:
    waiting: list[Step] = []
    try:
        for step in steps:
            waiting.append(step)
            if len(waiting) == PORTION:
                _take(summary, waiting)
                waiting = []
            yield step
    finally:
        _take(summary, waiting)


def _take(summary: Summary, steps: list[Step]) -> None:
    """Take these steps into account, together those that follow one another and are alike."""
    begun = 0
    for motion, together in groupby(map(_motion_of, steps)):
        alike = steps[begun : begun + sum(1 for _ in together)]
        begun += len(alike)
        if motion is None or len(alike) < FEW or not _took(summary, alike, motion):
            for step in alike:
                summary.add(step)


def _motion_of(step: Step) -> Motion | None:
    """The motion of an input whose errors are counted as they mostly are; None of all else."""
    entry = step.entry
    given = entry.given
    if not isinstance(given, Control) or entry.t is None or entry.truth is None:
        return None
    return given.motion if entry.judged and step.nees is not None else None


def _took(summary: Summary, steps: list[Step], motion: Motion) -> bool:
    """Whether inputs of one motion could be taken into account together."""
    start, entries = summary._reckoned, [step.entry for step in steps]
    t = np.array([entry.t for entry in entries])
    if start is None or start.ndim > 1 or not np.diff(t).all():
        return False
    U = np.array([entry.given.u for entry in entries if isinstance(entry.given, Control)])
    reckoned = moved(start, motion, U)
    before = np.concatenate([start[None], reckoned[:-1]])
    if not is_planar(motion.F(before, U), reckoned - before):
        return False
    if _any_lost(steps):
        for step in steps:
            summary.evidence.add(step)
    else:
        summary.evidence.lost_from, summary.evidence.last_nees = None, steps[-1].nees
    summary.steps += len(steps)
    summary.inputs += len(steps)
    summary.last_t, summary._reckoned = entries[-1].t, reckoned[-1]
    summary._instants.hold(entries[-1])
    estimated = np.array([step.posterior.mean for step in steps])
    truth = np.array([entry.truth for entry in entries])
    for pose, position, heading in (
        (estimated, summary.position, summary.heading),
        (reckoned, summary.reckoned_position, summary.reckoned_heading),
    ):
        e = error(Gaussian(pose, pose), truth)
        _add(position, np.hypot(e[:, 0], e[:, 1]), t)
        _add(heading, e[:, 2], t)
    if summary.expected_path is not None:
        _add(summary.path, path_error(estimated[:, :2], summary.expected_path), t)
    return True


def _any_lost(steps: list[Step]) -> bool:
    """Whether any belief is impossible, or its NEES beyond the quantile."""
    judged = [step.nees for step in steps if step.nees is not None]
    dof = [int(nees.dof) for nees in judged]
    beyond = {rank: quantile(LOST, rank) for rank in set(dof)}
    over = np.array([nees.value for nees in judged]) > np.array([beyond[rank] for rank in dof])
    return bool(over.any()) or any(nees.impossible for nees in judged)


def _add(errors: Errors, e: Array, t: Array) -> None:
    """Take errors of different instants into account : (n,) each"""
    errors.add(float(e[0]), float(t[0]))
    settled = e[:-1]
    errors._n += len(settled)
    errors._total += float(settled.sum())
    errors._squares += float(settled @ settled)
    errors._largest = max(errors._largest, float(abs(settled).max(initial=0.0)))
    errors._last, errors._instant = float(e[-1]), float(t[-1])
