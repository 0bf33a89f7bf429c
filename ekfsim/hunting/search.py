"""From nothing to the best list: few runs for every list, more for the best of them. What is said
of lists here holds of starts as well.

Lists are looked at in rounds. Of each round the best by a few runs are looked at with more, and the
best of these, of all rounds so far, are the parents of the next round's lists; some lists are
always made by chance. How far a search comes is told in lists, so that it is the same on any
machine and with any number of workers; a clock may only end it between two rounds.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ekfsim.hunting.changes.variants import Variant
from ekfsim.hunting.crew import Judge
from ekfsim.hunting.goals import Count
from ekfsim.scene import Scene

ROUND = 128  # lists
FEW, MORE = 64, 256  # runs of every list, and of the best of a round
BEST = 16  # of a round are looked at with more runs
PARENTS = 12
FRESH = 0.25  # share of a round's lists that are made by chance
CROSSED = 0.3  # and of the rest by crossing two parents
KEY = 3  # of the search's own generator, apart from those of draws


class Candidates(Protocol):
    """What is looked through: lists of commands, or starts."""

    def by_chance(self, rng: np.random.Generator) -> Variant:
        """Any."""

    def changed(self, one: Variant, rng: np.random.Generator) -> Variant:
        """One beside another."""

    def crossed(self, one: Variant, other: Variant, rng: np.random.Generator) -> Variant:
        """Part of one and part of another."""


@dataclass(frozen=True)
class Seen:
    """A list, and how many runs did what is wanted."""

    variant: Variant
    count: Count

    @property
    def rank(self) -> tuple[float, int]:
        """Greater is better: more runs, then fewer commands."""
        return self.count.share, -self.variant.size


@dataclass
class Search:
    """How far a search has come."""

    looked_at: int = 0  # lists
    runs: int = 0
    best: tuple[Seen, ...] = ()  # the best first


def searched(
    scene: Scene, space: Candidates, judge: Judge, lists: int, begin: Sequence[Variant] = ()
) -> Iterator[Search]:
    """The state of a search after each round, until so many lists were looked at.

    begin : lists to begin with, before those that are made by chance
    """
    rng = np.random.Generator(
        np.random.PCG64(np.random.SeedSequence([scene.seed], spawn_key=(KEY,)))
    )
    known, state = set[Variant](), Search()
    waiting = list(begin)
    while state.looked_at < lists:
        size = min(ROUND, lists - state.looked_at)
        new = _new_lists(space, state.best, waiting, size, known, rng)
        if not new:
            return  # there are no more
        waiting.clear()
        state = _round(scene, judge, state, new)
        yield state
        if state.best[0].count.share == 1:
            return  # no list is better


def _new_lists(
    space: Candidates, parents: Sequence[Seen], waiting: Sequence[Variant], size: int,
    known: set[Variant], rng: np.random.Generator,
) -> list[Variant]:  # fmt: skip
    """Lists that were not looked at before, in a fixed order."""
    new = list[Variant]()
    for one in _offered(space, parents, waiting, 4 * size, rng):
        if one not in known:
            known.add(one)
            new.append(one)
        if len(new) == size:
            break
    return new


def _offered(
    space: Candidates, parents: Sequence[Seen], waiting: Sequence[Variant], most: int,
    rng: np.random.Generator,
) -> Iterator[Variant]:  # fmt: skip
    yield from waiting
    yield from (space.changed(one, rng) for one in waiting for _ in range(ROUND // 4))
    for _ in range(most):
        if not parents or rng.random() < FRESH:
            yield space.by_chance(rng)
            continue
        one = parents[int(rng.integers(len(parents)))].variant
        if rng.random() < CROSSED:
            other = parents[int(rng.integers(len(parents)))].variant
            yield space.crossed(one, other, rng)
        else:
            yield space.changed(one, rng)


def _round(scene: Scene, judge: Judge, state: Search, new: Sequence[Variant]) -> Search:
    counts = judge(scene, new, 0, FEW)
    seen = sorted(map(Seen, new, counts), key=lambda one: one.rank, reverse=True)[:BEST]
    more = judge(scene, [one.variant for one in seen], FEW, MORE - FEW)
    tried = [Seen(one.variant, one.count.plus(c)) for one, c in zip(seen, more, strict=True)]
    best = sorted([*state.best, *tried], key=lambda one: one.rank, reverse=True)[:PARENTS]
    runs = state.runs + FEW * len(new) + (MORE - FEW) * len(seen)
    return Search(state.looked_at + len(new), runs, tuple(best))
