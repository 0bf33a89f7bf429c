"""One recorded log, filtered again with one change after another, within a budget."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ekfsim.diagnostics.verdict import Evidence
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.why.changes.guesses import Family
from ekfsim.why.records import REPLAYS, Change, Heard, Mechanism, Outcome, Tried, together
from ekfsim.why.trying.logs import Rows, gathered, rows_of
from ekfsim.why.trying.minimal import SpentError
from ekfsim.why.trying.replaying import cured, replayed

MOST_ROWS = 64  # at once
TOLD_IN = 100  # parts of replays, how far they have come


class Guess(NamedTuple):
    """A guess that was tried, and how likely the readings are under it."""

    family: Family | None
    value: float
    tried: Tried
    mean_nis: float
    likelihood: float
    dof: int

    @property
    def mechanism(self) -> Mechanism | None:
        """What it would be."""
        return None if self.family is None else self.family.mechanism(self.value)


class LogTrials:
    """What came of each change of one log."""

    def __init__(
        self, scene: Scene, steps: Sequence[Step], budget: int, heard: Heard | None
    ) -> None:
        self.scene, self.steps, self.budget, self._heard = scene, steps, budget, heard
        self.entries = [step.entry for step in steps]
        self.evidence = Evidence()
        for step in steps:
            self.evidence.add(step)
        rows = rows_of(scene, self.entries, [Change("reading", "nothing")])
        self.was: Outcome = rows.outcome(0)
        self.lost_from = int(rows.lost_from[0]) if rows.lost_from[0] >= 0 else None
        self.likelihood, self.dof = float(rows.likelihood[0]), int(rows.dof[0])
        self.replays = self._before = 0  # _before: those that are not under way
        self.guesses: list[Guess] = []
        self.surprising: dict[int, str] = {}  # the target of each reading that is, by its index

    def beside(
        self, changes: Sequence[Change], of: Sequence[tuple[Family | None, float]]
    ) -> list[Guess]:
        """Try changes of single entries side by side, each of a family with a value."""
        found: list[Guess] = []
        fit = max(self.budget - self.replays, 0)
        for first in range(0, min(len(changes), fit), MOST_ROWS):
            some = changes[first : min(first + MOST_ROWS, fit)]
            self._count(len(some))
            rows = rows_of(self.scene, self.entries, some, self._along)
            found += [
                self._guess(rows, row, change, *of[first + row]) for row, change in enumerate(some)
            ]
        self.guesses += found
        if len(found) < len(changes):
            raise SpentError
        return found

    def alone(self, change: Change, family: Family | None = None, value: float = 0.0) -> Guess:
        """Try one change by itself."""
        self._count(1)
        rows = gathered(self._along(replayed(self.scene, (change,))), 1)
        found = self._guess(rows, 0, change, family, value)
        self.guesses.append(found)
        return found

    def cures(self, changes: Sequence[Change]) -> bool:
        """Whether changes of single entries cure together."""
        self._count(1)
        one = together("all of these", tuple(changes))
        rows = rows_of(self.scene, self.entries, [one], self._along)
        return cured(self.was, rows.outcome(0))

    def _guess(
        self, rows: Rows, row: int, change: Change, family: Family | None, value: float
    ) -> Guess:
        outcome, since = rows.outcome(row), int(rows.lost_from[row])
        likelier = family is None or float(rows.likelihood[row]) > self.likelihood
        cures = likelier and cured(self.was, outcome)
        lost_from = since if since >= 0 else None
        tried = Tried(change, cures, float(rows.nees[row]), lost_from, outcome)
        dof = int(rows.dof[row])
        mean = float(rows.nis[row]) / dof if dof else math.nan
        return Guess(family, value, tried, mean, float(rows.likelihood[row]), dof)

    def _count(self, replays: int) -> None:
        if self.replays + replays > self.budget:
            raise SpentError
        self._before, self.replays = self.replays, self.replays + replays

    def _along(self, steps: Iterable[Step]) -> Iterator[Step]:
        """The steps of some replays, and how far they have come."""
        often = max(len(self.entries) // TOLD_IN, 1)
        for number, step in enumerate(steps):
            if self._heard is not None and number % often == 0:
                now = (self.replays - self._before) * number // len(self.entries)
                self._heard(self._before + now, self.budget, REPLAYS)
            yield step
        if self._heard is not None:
            self._heard(self.replays, self.budget, REPLAYS)


def plain(
    changes: Sequence[Change],
) -> tuple[Sequence[Change], Sequence[tuple[Family | None, float]]]:
    """Changes that have no value."""
    return changes, [(None, 0.0)] * len(changes)
