"""Motions and readings, each with its time → Entries, in order."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.given.given import is_own
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.start.belief import assumed, at_fix, at_truth, bears_out
from ekfsim.files.logs.start.course import is_fix
from ekfsim.files.logs.start.instant import first_known, of_the_motion, span, tell_unknown
from ekfsim.files.logs.truth import Truth
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Landmark
from ekfsim.world import World

SAME = 1e-6  # s; times that differ by no more are one: 0.3 and 0.1 + 0.2, or a Unix time as a float


@dataclass(frozen=True)
class Motions:
    """Motion inputs, one after another, each over a time that a reading may cut in two."""

    motion: Motion
    begin: Array  # (n,) s
    end: Array  # (n,) s
    u: Array  # (n, m)
    # (m,) which entries of u grow with the time: ways, turns, dt; the others are rates
    amounts: Booleans

    def part(self, k: int, begin: float, end: float) -> Control:
        """What is held from `begin` to `end` of the k-th motion."""
        if begin == self.begin[k] and end == self.end[k]:
            return Control(self.motion, self.u[k])
        share = (end - begin) / (self.end[k] - self.begin[k])
        return Control(self.motion, np.where(self.amounts, self.u[k] * share, self.u[k]))

    def until(self, t: float) -> list[Control]:
        """What is held up to an instant."""
        begin, end = self.begin.tolist(), self.end.tolist()
        return [self.part(k, begin[k], min(end[k], t)) for k in range(len(end)) if begin[k] < t]

    def since(self, t: float) -> "Motions":
        """What is left of them from an instant on."""
        left = self.end > t
        begin, end, u = self.begin[left], self.end[left], self.u[left].copy()
        if len(begin) and begin[0] < t:
            u[0] = np.where(self.amounts, u[0] * ((end[0] - t) / (end[0] - begin[0])), u[0])
            begin = np.concatenate([[t], begin[1:]])
        return Motions(self.motion, begin, end, u, self.amounts)


class Sample(NamedTuple):
    """A reading and its stamp."""

    t: float  # s
    reading: Reading
    delay: float = 0.0  # s, how old it was then: it is used at t − delay


@dataclass(frozen=True)
class Timeline:
    """All that was recorded."""

    name: str  # of the log, as messages call it
    start: float  # s
    motions: Motions
    samples: Sequence[Sample]  # in any order; those of one instant as they are to be used
    truth: Truth | None = None
    landmarks: tuple[Landmark, ...] | None = None
    between: bool = True  # whether errors are counted at readings between two motions

    def recorded(self, world: World, reading: DocumentReading, warnings: list[str]) -> Recorded:
        """The log.
        It starts at the first instant at which the truth is known, where nobody told the start.
        """
        truth, start, ends = self.truth, self.start, self.motions.end
        if not len(ends):
            wrong = "the motion has one instant alone: there is no way to localize on"
            raise UsageError(f"{self.name}: {wrong}; it needs two rows of different times")
        if truth is not None:
            truth = of_the_motion(truth, start, ends, self.name, warnings)
        if truth is not None and not all(world.told.start_said):
            known = first_known(truth, start, ends, self.name, warnings)
            truth, start = (None, start) if known is None else (truth, known)
        if truth is not None:
            tell_unknown(truth, start, ends, self.name, warnings)
        elif (begun := self._at_fix(world, reading, warnings)) is not None:
            return Recorded(begun, self.landmarks, warnings)
        entries = self._entries(self.samples, start, truth, warnings)
        pose = entries[0].truth
        first = (
            assumed(world, reading, self.name, warnings)
            if pose is None
            else at_truth(world, reading, pose)
        )
        return Recorded(Log(entries, first, pose is not None), self.landmarks, warnings)

    def _at_fix(self, world: World, reading: DocumentReading, warnings: list[str]) -> Log | None:
        """The log from its first fix on; None where there is none, where somebody told the start,
        or where the fixes bear out the start of a world of one's own. The authors' own programs
        (`coded`) take no fix for a start.
        """
        samples, fix = self._first_fix()
        if fix is None or reading == "coded" or all(world.told.start_said[:2]):
            return None
        found = list[str]()
        entries = self._entries(samples, fix.t, None, found)
        first = at_fix(world, reading, fix.reading, entries, self.name, found)
        if is_own(world) and bears_out(world, reading, first, self.motions.until(fix.t)):
            return None
        warnings += found
        return Log(entries, first, start_known=False)

    def _entries(
        self, samples: Sequence[Sample], start: float, truth: Truth | None, warnings: list[str]
    ) -> tuple[Entry, ...]:
        """What happened from an instant on."""
        motions = self.motions.since(start)
        happened = [
            (start, None, True),
            *_merged(motions, self._within(samples, start, motions, warnings), self.between),
        ]
        truths = _truths(truth, np.array([t for t, _, _ in happened]))
        return tuple(
            Entry(index, given, truth, t=t, judged=judged)
            for index, ((t, given, judged), truth) in enumerate(zip(happened, truths, strict=True))
        )

    def _first_fix(self) -> tuple[Sequence[Sample], Sample | None]:
        """The readings but for the first that tells the position, and that one, where there is one
        while the robot moves.
        """
        edges = np.concatenate([[self.start], self.motions.end])
        times = _snapped(_times(self.samples), edges)
        for i in np.argsort(times, kind="stable").tolist():
            if edges[0] <= times[i] < edges[-1] and is_fix(self.samples[i].reading):
                fix = Sample(float(times[i]), self.samples[i].reading)
                return [*self.samples[:i], *self.samples[i + 1 :]], fix
        return self.samples, None

    def _within(
        self, samples: Sequence[Sample], start: float, motions: Motions, warnings: list[str]
    ) -> list[Sample]:
        """The readings that the motions reach, by time."""
        edges = np.concatenate([[start], motions.end])
        times = _snapped(_times(samples), edges)
        kept = [
            Sample(float(times[i]), samples[i].reading)
            for i in np.argsort(times, kind="stable")
            if start <= times[i] <= edges[-1]
        ]
        if missed := len(samples) - len(kept):
            readings = "1 reading lies" if missed == 1 else f"{missed} readings lie"
            spans = f"readings are of {span(times)}, the motion of {span(edges)}"
            warnings.append(
                f"{self.name}: {readings} before or after the motion: left out; {spans}"
            )
        if not kept:
            warnings.append(f"{self.name}: no reading is left: the filter follows the motion alone")
        return kept


def _times(samples: Sequence[Sample]) -> Array:
    """When each of them was measured : (n,) s"""
    return np.array([sample.t - sample.delay for sample in samples])


def _snapped(t: Array, edges: Array) -> Array:
    """The times, those that are an edge's but for rounding as the edge has it.
    edges : (n,) in order
    """
    after = np.minimum(np.searchsorted(edges, t), len(edges) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(
        np.abs(edges[after] - t) < np.abs(edges[before] - t), edges[after], edges[before]
    )
    return np.where(np.abs(nearest - t) <= SAME, nearest, t)


# t, what the filter is given, whether errors are counted
Happened = tuple[float, Control | Reading | None, bool]


def _merged(motions: Motions, samples: Sequence[Sample], between: bool) -> list[Happened]:
    """Predict up to each reading, take it, predict the rest."""
    happened, i = list[Happened](), 0
    for k, (begin, end) in enumerate(
        zip(motions.begin.tolist(), motions.end.tolist(), strict=True)
    ):
        now = begin
        while i < len(samples) and samples[i].t < end:
            if samples[i].t > now:
                happened.append((samples[i].t, motions.part(k, now, samples[i].t), between))
                now = samples[i].t
            happened.append((now, samples[i].reading, between or now == motions.begin[0]))
            i += 1
        happened.append((end, motions.part(k, now, end), True))
        while i < len(samples) and samples[i].t == end:
            happened.append((end, samples[i].reading, True))
            i += 1
    return happened


def _truths(truth: Truth | None, t: Array) -> list[Array | None]:
    """The true pose at each instant, None where it is unknown."""
    if truth is None:
        return [None] * len(t)
    poses = truth.at(t)
    return [
        pose if known else None
        for pose, known in zip(poses, np.isfinite(poses[:, 0]).tolist(), strict=True)
    ]
