"""One press of `n` is one view; `p` is a list index."""

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.records import Command, Move, Reading, Repeat, Sense, Step


@dataclass(frozen=True, slots=True)
class View:
    """What is on the screen after so many presses of `n`. View 0 is the world before the first command.

    A sense has two: first the beam, while the estimate is still the old one, then the revised estimate without it.
    """

    number: int
    step: Step
    beam: bool
    settled: list[Array]  # earlier estimated positions; shared by all views, and only ever grows
    corners: int  # how many of them lie behind this view

    @property
    def belief(self) -> Gaussian:
        """The belief that is drawn: the prior while the beam is shown, the posterior after."""
        return self.step.prior if self.beam else self.step.posterior

    def path(self) -> Array:
        """All estimated positions from the start to the one that is drawn : (n, 2) m"""
        return np.array([*self.settled[: self.corners], self.belief.mean[:2]])


def views(steps: Iterable[Step]) -> Iterator[View]:
    """Every view of a run, in order. Until the next move the path's last corner moves with each revised estimate."""
    settled: list[Array] = []
    number = itertools.count()
    for step in steps:
        if isinstance(step.entry.command, Move):
            settled.append(step.prior.mean[:2])
        if isinstance(step.entry.given, Reading):
            yield View(next(number), step, True, settled, len(settled))
        yield View(next(number), step, False, settled, len(settled))


def number_of_views(commands: Iterable[Command]) -> int:
    """How many views a run of these commands has, counted without running them.

    >>> number_of_views([Repeat(10, (Sense(0.0), Move(1.0, 0.0)))])
    31
    """

    def count(command: Command) -> int:
        if isinstance(command, Repeat):
            return command.times * sum(map(count, command.commands))
        return 2 if isinstance(command, Sense) else 1

    return 1 + sum(map(count, commands))


class Playback:
    """The views of a run by number, computed when first asked for and kept for the way back."""

    def __init__(self, steps: Iterable[Step]) -> None:
        self._coming = views(steps)
        self._seen: list[View] = []

    def __iter__(self) -> Iterator[View]:
        """Every view, from the first to the last."""
        for number in itertools.count():
            view = self.view(number)
            if view is None:
                return
            yield view

    def view(self, number: int) -> View | None:
        """View `number`, or None where the run is over before it."""
        while len(self._seen) <= number:
            following = next(self._coming, None)
            if following is None:
                return None
            self._seen.append(following)
        return self._seen[number]
