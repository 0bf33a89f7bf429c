"""One press of `n` is one view; `p` is a list index."""

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ekfsim.commands import Move, Untold
from ekfsim.errors import StepError
from ekfsim.files.results.outputs import kept
from ekfsim.filters.belief import Belief, Gaussian, posed
from ekfsim.geometry import Array
from ekfsim.models.layout import Layout
from ekfsim.records import Control, Reading, Step
from ekfsim.views.terminal.parting import Apart, Parting

T = TypeVar("T")
GATHERED = 200  # motion inputs of a driven or recorded robot in one view, at most


@dataclass(frozen=True, slots=True)
class View:
    """What is on the screen after so many presses of `n`.
    View 0 is the world before anything happens.

    A reading has two: first the beam, while the estimate is still the old one, then the revised
    estimate without it. The motion inputs of a driven or recorded robot that follow each other
    share one, and its step is the last of them.
    """

    number: int
    step: Step
    beam: bool
    settled: list[Array]  # earlier estimated positions; shared by all views, and only ever grows
    corners: int  # how many of them lie behind this view
    inputs: int = 1  # how many steps the view gathers
    # the belief before the first of them, where more than one may be gathered
    before: Belief | None = None
    since: float | None = None  # s, the instant of the first of the steps, as stamped
    start: float = 0.0  # s, the stamp of the start
    others: tuple["View", ...] = ()  # the same view as other filters have it, that watch beside
    apart: tuple[Apart, ...] = ()  # of each of them: whether it believes something else

    @property
    def belief(self) -> Belief:
        """The belief that is shown: the prior while the beam is, the posterior after."""
        return self.step.prior if self.beam else self.step.posterior

    @property
    def layout(self) -> Layout:
        """What the entries of the estimated state are."""
        return self.step.layout

    @property
    def pose(self) -> Gaussian:
        """What that belief says of the pose, which is drawn : (3,), (3, 3)"""
        return posed(self.belief, self.layout)

    @property
    def span(self) -> tuple[float, float] | None:
        """The first and the last instant of its steps, in s since the start;
        None where there is no clock.
        """
        last = self.step.entry.t
        return (
            None
            if last is None
            else ((last if self.since is None else self.since) - self.start, last - self.start)
        )

    def path(self) -> Array:
        """All estimated positions from the start to the one that is drawn : (n, 2) m"""
        return np.array([*self.settled[: self.corners], _position(self.belief, self.layout)])


def views(steps: Iterable[Step]) -> Iterator[View]:
    """Every view of a run, in order.
    Until the next motion the path's last corner moves with each revised estimate.
    """
    settled: list[Array] = []
    number, start = itertools.count(), None
    for first, step, inputs in _seen(steps):
        start = first.entry.t or 0.0 if start is None else start
        before = first.prior if _gathered(first) else None
        if before is not None or isinstance(step.entry.command, Move | Untold):
            settled.append(_position(first.prior, first.layout))
        if isinstance(step.entry.given, Reading):
            yield View(next(number), step, True, settled, len(settled), start=start)
        yield View(
            next(number), step, False, settled, len(settled), inputs, before, first.entry.t, start
        )


def together(
    steps: Iterable[Step], others: Iterable[Iterable[Step]], names: Sequence[str] = ()
) -> Iterator[View]:
    """Every view of a run, with what other filters make of the same entries.

    names : of the filters, as the scene has them; told where they part
    """
    partings = [Parting(names[0], name) for name in names[1:]]
    first = views(kept(steps, [parting.take for parting in partings]))
    held = itertools.zip_longest(others, partings)
    beside = [views(each if p is None else kept(each, [p.hold])) for each, p in held]
    for view, *same in zip(first, *beside, strict=True):
        if not same:
            yield view
            continue
        index = view.step.entry.index - (1 if view.beam else 0)  # what is shown of it
        apart = tuple(parting.until(index) for parting in partings)
        yield replace(view, others=tuple(same), apart=apart)


def _seen(steps: Iterable[Step]) -> Iterator[tuple[Step, Step, int]]:
    """The steps that a view gathers: the first, the last and how many.
    Those between are not kept.
    """
    first: Step | None = None
    last: Step | None = None
    inputs = 0
    coming = UntilFailure(steps)
    for step in coming:
        gathered = _gathered(step)
        if first is not None and last is not None and not gathered:
            yield first, last, inputs
            first = None
        if not gathered:
            yield step, step, 1
            continue
        first, last, inputs = (step, step, 1) if first is None else (first, step, inputs + 1)
        if inputs == GATHERED:
            yield first, last, inputs
            first = None
    if first is not None and last is not None:
        yield first, last, inputs
    if coming.failure is not None:
        raise coming.failure


def _gathered(step: Step) -> bool:
    """Whether a step shares its view with its neighbours:
    a motion input that no command asked for.
    """
    return step.entry.command is None and isinstance(step.entry.given, Control)


def _position(belief: Belief, layout: Layout) -> Array:
    """The estimated position : (2,) m"""
    return layout.pose(belief.mean)[:2]


class UntilFailure(Iterator[T]):
    """What comes before a run fails, if it does; the failure is kept."""

    def __init__(self, coming: Iterable[T]) -> None:
        self._coming = iter(coming)
        self.failure: StepError | None = None

    def __next__(self) -> T:
        try:
            return next(self._coming)
        except StepError as failure:
            self.failure = failure
            raise StopIteration from None


class Tally:
    """Counts the views that steps have, as the steps go by."""

    def __init__(self) -> None:
        self.views = 0
        self._inputs = 0  # in the view that is being gathered

    def write(self, step: Step) -> None:
        """Count the views that this step begins."""
        self._inputs = self._inputs % GATHERED + 1 if _gathered(step) else 0
        if self._inputs <= 1:
            self.views += 2 if isinstance(step.entry.given, Reading) else 1


class Playback:
    """The views of a run by number, computed when first asked for and kept for the way back.

    A run that fails ends before its `failure`.
    """

    def __init__(
        self,
        steps: Iterable[Step],
        others: Iterable[Iterable[Step]] = (),
        names: Sequence[str] = (),
    ) -> None:
        self._coming = UntilFailure(together(steps, others, names))
        self._seen: list[View] = []

    @property
    def failure(self) -> StepError | None:
        """What the run failed by, once what comes before it has been asked for."""
        return self._coming.failure

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
