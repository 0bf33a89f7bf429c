"""Of how many runs it holds: as they stand, and with a change."""

from collections.abc import Sequence

import numpy as np

from ekfsim.diagnostics.verdict import BAND
from ekfsim.geometry import Booleans, Integers
from ekfsim.scene import Scene
from ekfsim.study.block import Watched, watched_along
from ekfsim.study.comparison import of_shares
from ekfsim.study.counting import bounds
from ekfsim.study.pairs import Shared
from ekfsim.why.records import Change, Outcome, Shares
from ekfsim.why.trying.replaying import replayed


def outcomes(watched: Watched) -> dict[Outcome, Booleans]:
    """How each of N runs ended : (N,) for each word"""
    nis, dof = watched.readings.nis, watched.readings.dof
    lost, some = watched.lost_from >= 0, dof > 0
    high, low = (1 + BAND) / 2, (1 - BAND) / 2
    above = ~lost & some & (nis > bounds(high, dof))
    below = ~lost & some & (nis < bounds(low, dof))
    return {
        "lost": lost,
        "over-confident": above,
        "over-cautious": below,
        "consistent": ~(lost | above | below),
    }


class Crowd:
    """Runs of a scene, each of them also with changes, on the same draws."""

    def __init__(self, scene: Scene, runs: int, of: Outcome) -> None:
        self._scene, self._of = scene, of
        self.numbers: Integers = np.arange(runs)
        self._bad: dict[tuple[int, ...], Booleans] = {}
        self._kept: list[Change] = []  # a change is known by its place here

    def bad(self, changes: Sequence[Change] = ()) -> Booleans:
        """Which runs end as badly, with changes : (N,)"""
        key = tuple(self._place(one) for one in changes)
        if key not in self._bad:
            steps = replayed(self._scene, changes, self.numbers)
            ended = outcomes(watched_along(self._scene, self.numbers, steps))
            self._bad[key] = ended[self._of]
        return self._bad[key]

    def shares(self, change: Change, changes: Sequence[Change] = ()) -> Shares:
        """What a change does, or several together that are told as one."""
        a, b = self.bad(), self.bad(changes or (change,))
        found = of_shares(Shared.of(a, b))
        return Shares(len(a), found.a, found.b, found.low, found.high, change, self._of)

    def _place(self, change: Change) -> int:
        for place, one in enumerate(self._kept):
            if one is change:
                return place
        self._kept.append(change)
        return len(self._kept) - 1
