"""Of how many runs it holds: as they stand, and with a change."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ekfsim.diagnostics.verdict import BAND
from ekfsim.geometry import Booleans, Integers
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.study.block import Watched, at_once, length_of, watched_along
from ekfsim.study.comparison import of_shares
from ekfsim.study.counting import bounds
from ekfsim.study.pairs import Shared
from ekfsim.why.records import Change, Heard, Outcome, Shares
from ekfsim.why.trying.replaying import changed, replayed


def badly(watched: Watched, outcome: Outcome) -> Booleans:
    """Which of N runs ended as badly as one that is lost, over-confident or over-cautious. For a
    sum of NIS outside its band it does not matter whether the run is lost besides : (N,)
    """
    nis, dof = watched.readings.nis, watched.readings.dof
    if outcome == "lost":
        return watched.lost_from >= 0
    if outcome == "over-confident":
        return (dof > 0) & (nis > bounds((1 + BAND) / 2, dof))
    return (dof > 0) & (nis < bounds((1 - BAND) / 2, dof))


def outcomes(watched: Watched) -> dict[Outcome, Booleans]:
    """How each of N runs ended, by the first word that holds : (N,) for each"""
    lost = badly(watched, "lost")
    above, below = badly(watched, "over-confident"), badly(watched, "over-cautious")
    return {
        "lost": lost,
        "over-confident": above & ~lost,
        "over-cautious": below & ~lost,
        "consistent": ~(lost | above | below),
    }


class Crowd:
    """Runs of a scene, each of them also with changes, on the same draws."""

    def __init__(self, scene: Scene, runs: int, of: Outcome, heard: Heard | None = None) -> None:
        self._scene, self._of, self._heard = scene, of, heard
        self.numbers: Integers = np.arange(runs)
        self._bad: dict[tuple[Change, ...], Booleans] = {}

    def bad(self, changes: Sequence[Change] = ()) -> Booleans:
        """Which runs end as badly, with changes : (N,)"""
        key = tuple(changes)
        if key not in self._bad:
            some = at_once(changed(self._scene, changes), 0, len(self.numbers))
            each = [self._portion(changes, self.numbers[first:][:runs]) for first, runs in some]
            self._bad[key] = np.concatenate([np.zeros(0, bool), *each])
        return self._bad[key]

    def _portion(self, changes: Sequence[Change], numbers: Integers) -> Booleans:
        """Of some of the runs, as many as fit the memory : (n,)"""
        steps = self._told(replayed(self._scene, changes, numbers), len(changes))
        return badly(watched_along(self._scene, numbers, steps), self._of)

    def _told(self, steps: Iterable[Step], changes: int) -> Iterator[Step]:
        """The steps, and how far they have come."""
        last, often = length_of(self._scene), "with a change" if changes else "as they stand"
        for step in steps:
            if self._heard is not None:
                self._heard(
                    min(step.entry.index, last), last, f"{len(self.numbers)} runs {often}, steps"
                )
            yield step

    def shares(self, change: Change, changes: Sequence[Change] = ()) -> Shares:
        """What a change does, or several together that are told as one."""
        a, b = self.bad(), self.bad(changes or (change,))
        found = of_shares(Shared.of(a, b))
        return Shares(len(a), found.a, found.b, found.low, found.high, change, self._of)
