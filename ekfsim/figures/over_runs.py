"""What many simulated runs of a scene say, each by itself:
a comparison of two filters needs more than one run.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ekfsim.diagnostics.verdict import LOST
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.records import Control, Reading, Step
from ekfsim.study.counting import Judged

RUNS = 20


@dataclass(frozen=True)
class EachRun:
    """N runs side by side, at every instant as it stood after its last update : (N,) each"""

    position: Array  # m, RMSE of the estimate
    heading: Array  # rad
    reckoned_position: Array  # m, RMSE of what the motion inputs alone make of the first estimate
    reckoned_heading: Array  # rad
    nis: Array  # mean per number read
    beyond: Array  # the share of instants whose NEES lies beyond its 99.9 % quantile

    @classmethod
    def of(cls, steps: Iterable[Step], layout: Layout) -> "EachRun":
        """Of the steps of a simulated drive."""
        squares, nis = list[Array](), list[Array]()
        for step, reckoned in _instants(steps, nis):
            truth, measured = step.entry.truth, step.nees
            if truth is None or measured is None:
                continue
            both = np.stack([layout.pose(step.posterior.mean), layout.pose(reckoned)]) - truth
            e = np.concatenate([np.sum(both[..., :2] ** 2, axis=-1), wrap(both[..., 2]) ** 2])
            beyond = Judged.of(measured, step.posterior.mean).above(LOST)
            squares.append(np.concatenate([e, beyond[None]]))
        position, off, heading, turned, beyond = np.mean(squares, axis=0)
        means = np.nanmean(nis, axis=0) if nis else np.full(position.shape, np.nan)
        return cls(
            np.sqrt(position), np.sqrt(heading), np.sqrt(off), np.sqrt(turned), means, beyond
        )


def _instants(steps: Iterable[Step], nis: list[Array]) -> Iterator[tuple[Step, Array]]:
    """The last step of each instant, and where the motion inputs alone would be;
    the NIS per number of each reading.
    """
    before: Step | None = None
    reckoned = np.empty(0)
    for step in steps:
        if before is None:
            reckoned = step.posterior.mean
        elif step.entry.t != before.entry.t:
            yield before, reckoned
        match step.entry.given:
            case Control(motion, u):
                reckoned = motion.f(reckoned, u)
            case Reading() if step.correction is not None:
                nis.append(step.correction.nis / step.correction.innovation.shape[-1])
        before = step
    assert before is not None
    yield before, reckoned


def spread(values: Array, digits: int = 3) -> str:
    """The mean of N runs, and from which to which they reach.

    >>> spread(np.array([0.1, 0.2, 0.4]))
    '0.233 (0.1 to 0.4)'
    """
    return f"{values.mean():.{digits}g} ({values.min():.{digits}g} to {values.max():.{digits}g})"
