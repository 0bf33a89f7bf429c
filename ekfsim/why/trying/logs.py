"""One log filtered many times side by side, with another change in each row."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.verdict import BAND, LOST
from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.geometry import Array, Integers
from ekfsim.localization import filter_of, localize
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.scene import Scene
from ekfsim.study.counting import Judged, bounds
from ekfsim.why.changes.recorded import Louder, LouderMotion
from ekfsim.why.records import Change, Outcome


class Rows(NamedTuple):
    """How a log ends with each of N changes : (N,) each"""

    nis: Array  # ΣNIS, refused readings included
    dof: Integers
    likelihood: Array  # log of the readings' density, but for a constant
    nees: Array  # at the end; nan where no truth is known
    lost_from: Integers  # −1 where it is not lost
    known: bool  # whether there is a truth to be lost from

    def outcome(self, row: int) -> Outcome:
        """How one of them ended."""
        if self.lost_from[row] >= 0:
            return "lost"
        dof = self.dof[row : row + 1]
        if not dof[0]:
            return "recorded"
        low, high = (float(bounds(p, dof)[0]) for p in ((1 - BAND) / 2, (1 + BAND) / 2))
        if self.nis[row] > high:
            return "over-confident"
        return "over-cautious" if self.nis[row] < low else "consistent"


def rows_of(
    scene: Scene,
    entries: Sequence[Entry],
    changes: Sequence[Change],
    along: Callable[[Iterable[Step]], Iterable[Step]] = iter,
) -> Rows:
    """The log with each of some changes of its entries, side by side. along : sees every step"""
    assert scene.log is not None
    N = len(changes)
    x, P = scene.log.first
    belief = Gaussian(np.broadcast_to(x, (N, *x.shape)), np.broadcast_to(P, (N, *P.shape)))
    runs = np.full(N, scene.run)
    steps = localize(
        abreast(entries, changes), filter_of(scene, runs), belief, scene.guard, scene.world.layout
    )
    return gathered(along(steps), N)


def gathered(steps: Iterable[Step], N: int) -> Rows:
    """What N rows of steps come to."""
    nis, dof, likelihood = np.zeros(N), np.zeros(N, np.int64), np.zeros(N)
    nees, lost_from, known = np.full(N, np.nan), np.full(N, -1), False
    for step in steps:
        if step.correction is not None:
            of_one, numbers, density = _read(step.correction)
            nis, dof, likelihood = nis + of_one, dof + numbers, likelihood + density
        if step.nees is not None:
            known = True
            judged = Judged.of(step.nees, step.posterior.mean)
            nees = np.atleast_1d(judged.value)
            since = np.where(lost_from < 0, step.entry.index, lost_from)
            lost_from = np.where(judged.above(LOST), since, -1)
    return Rows(nis, dof, likelihood, nees, lost_from, known)


def _read(correction: Correction) -> tuple[Array, Integers, Array]:
    """NIS, its numbers, and the log of the density of one reading in each row : (N,) each"""
    there = ~np.isnan(correction.nis)
    k = correction.innovation.shape[-1]
    S = np.where(there[..., None, None], correction.S, np.eye(k))
    nis = np.where(there, correction.nis, 0.0)
    return nis, there * k, np.where(there, -0.5 * (nis + np.linalg.slogdet(S)[1]), 0.0)


def abreast(entries: Sequence[Entry], changes: Sequence[Change]) -> Iterator[Entry]:
    """The entries of one log, N times side by side, with one of N changes of single entries in
    each.
    """
    rows = [change.of_entries(iter(entries)) for change in changes]
    for entry, each in zip(entries, zip(*rows, strict=True), strict=True):
        yield _stacked(entry, each)


def _stacked(entry: Entry, rows: Sequence[Entry]) -> Entry:
    N, given, truth = len(rows), entry.given, entry.truth
    if truth is not None:
        truth = np.broadcast_to(truth, (N, *truth.shape))
    match given:
        case Reading(sensor, z):
            each = [row.given for row in rows if isinstance(row.given, Reading)]
            z = np.broadcast_to(z, (N, *z.shape)) if _same(each, given) else _stack(each, "z")
            factors = [one.sensor.factor if isinstance(one.sensor, Louder) else 1.0 for one in each]
            if any(factor != 1.0 for factor in factors):
                sensor = Louder(sensor, np.array(factors, float))
            return Entry(entry.index, Reading(sensor, z, given.name), truth, entry.command,
                         entry.bump, entry.t, entry.judged, entry.fix)  # fmt: skip
        case Control(motion, u):
            moves = [row.given for row in rows if isinstance(row.given, Control)]
            u = np.broadcast_to(u, (N, *u.shape)) if _same(moves, given) else _stack(moves, "u")
            louder = [
                one.motion.factor if isinstance(one.motion, LouderMotion) else 1.0 for one in moves
            ]
            if any(factor != 1.0 for factor in louder):
                motion = LouderMotion(motion, np.array(louder, float))
            return Entry(entry.index, Control(motion, u), truth, entry.command,
                         entry.bump, entry.t, entry.judged, entry.fix)  # fmt: skip
    return Entry(entry.index, given, truth, entry.command, entry.bump, entry.t, entry.judged)


def _same(each: Sequence[object], one: object) -> bool:
    return all(other is one for other in each)


def _stack(each: Sequence[object], name: str) -> Array:
    return np.stack([np.asarray(getattr(one, name)) for one in each])


def outcomes(rows: Rows) -> list[Outcome]:
    """How each of them ended."""
    return [rows.outcome(row) for row in range(len(rows.nis))]
