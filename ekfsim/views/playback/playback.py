"""One press of `n` is one view; `p` is a list index."""

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Protocol, TypeVar

from ekfsim.commands import Move, Untold
from ekfsim.diagnostics.unplaced import Unplaced
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.errors import StepError
from ekfsim.filters.belief import Belief
from ekfsim.filters.place import is_smoothed
from ekfsim.models.layout import Layout
from ekfsim.records import Control, Entry, Nees, Reading, Step
from ekfsim.views.playback.kept import kept
from ekfsim.views.playback.parting import Parting
from ekfsim.views.playback.trail import Trail, Way, Ways
from ekfsim.views.playback.view import Judged, View
from ekfsim.views.playback.zoom import Zoom

T = TypeVar("T")
GATHERED = 200  # motion inputs of a driven or recorded robot in one view, at most


def views(steps: Iterable[Step]) -> Iterator[View]:
    """Every view of a run, in order."""
    made = Unrolling()
    for group, over in _groups(steps):
        yield from made.take(group, over)


class Unrolling:
    """Makes views of steps as they come.
    Until the next motion the path's last corner moves with each revised estimate.
    """

    def __init__(self) -> None:
        self._settled, self._ways, self._evidence = Trail(), Ways(), Evidence()
        self._zoom = Zoom()
        self._numbers = itertools.count()
        self._start: float | None = None
        self._nees: Nees | None = None
        self._unplaced: Unplaced | None = None

    def take(self, group: Sequence[Step], over: bool = False) -> list[View]:
        """The views of the steps that come next, which one view gathers; of the last ones, where
        the run is over with them.
        """
        first, step = group[0], group[-1]
        self._start = first.entry.t or 0.0 if self._start is None else self._start
        for each in group:
            self._ways.take(each)
        self._ways.mark(step)
        self._unplaced = self._unplaced or Unplaced(first.posterior, first.layout)
        before = first.prior if _gathered(first.entry) else None
        was, now = self._unplaced.at(first.prior), self._unplaced.at(step.posterior)
        moves = before is not None or isinstance(step.entry.command, Move | Untold)
        if moves and not was:
            self._settled.append(*_position(first.prior, first.layout))
        shown = View(
            next(self._numbers), step, isinstance(step.entry.given, Reading),
            Way.now(self._settled), Way.now(self._ways.true), Way.now(self._ways.reckoned),
            Judged(self._nees, self._evidence.lost_from), start=self._start,
            across=self._zoom.take(first.prior, step), unplaced=was, was_unplaced=was,
        )  # fmt: skip
        made = [shown] if shown.beam else []
        for each in group:
            self._evidence.add(each)
        self._nees, evidence = step.nees, self._evidence
        revised = replace(
            shown,
            number=next(self._numbers) if shown.beam else shown.number, beam=False,
            judged=Judged(self._nees, evidence.lost_from, evidence if over else None),
            inputs=len(group), before=before, since=first.entry.t, unplaced=now,
        )  # fmt: skip
        return [*made, revised]


def together(
    steps: Iterable[Step], others: Iterable[Iterable[Step]], names: Sequence[str] = ()
) -> Iterator[View]:
    """Every view of a run, with what other filters make of the same entries.

    names : of the filters, as the scene has them; told where they part, but of a smoothed one,
    which is meant to
    """
    every = [None if is_smoothed(name) else Parting(names[0], name) for name in names[1:]]
    partings = [parting for parting in every if parting is not None]
    first = views(kept(steps, [parting.take for parting in partings]))
    held = itertools.zip_longest(others, every)
    beside = [views(each if p is None else kept(each, [p.hold])) for each, p in held]
    for view, *same in zip(first, *beside, strict=True):
        yield side_by_side(view, same, partings) if same else view


def side_by_side(view: View, same: Sequence[View], partings: Iterable[Parting]) -> View:
    """A view, with the same one as other filters have it."""
    index = view.step.entry.index - (1 if view.beam else 0)  # what is shown of it
    apart = tuple(parting.until(index) for parting in partings)
    return replace(view, others=tuple(same), apart=apart)


def _groups(steps: Iterable[Step]) -> Iterator[tuple[list[Step], bool]]:
    """The steps that a view gathers, and whether the run is over with them. It is known of each
    whether another follows before it is shown; where a run fails, nothing is over.
    """
    coming = UntilFailure(steps)
    groups = _gathering(coming)
    group = next(groups, None)
    while group is not None:
        following = next(groups, None)
        yield group, following is None and coming.failure is None
        group = following
    if coming.failure is not None:
        raise coming.failure


def _gathering(steps: Iterable[Step]) -> Iterator[list[Step]]:
    gathered: list[Step] = []
    for step in steps:
        if gathered and not _gathered(step.entry):
            yield gathered
            gathered = []
        if not _gathered(step.entry):
            yield [step]
            continue
        gathered.append(step)
        if len(gathered) == GATHERED:
            yield gathered
            gathered = []
    if gathered:
        yield gathered


def _gathered(entry: Entry) -> bool:
    """Whether the step of an entry shares its view with its neighbours:
    a motion input that no command asked for.
    """
    return entry.command is None and isinstance(entry.given, Control)


def _position(belief: Belief, layout: Layout) -> tuple[float, float]:
    """The estimated position, x and y in m."""
    x, y, _ = layout.pose(belief.mean).tolist()
    return x, y


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
        self.count(step.entry)

    def count(self, entry: Entry) -> None:
        """Count the views that the step of this entry begins."""
        self._inputs = self._inputs % GATHERED + 1 if _gathered(entry) else 0
        if self._inputs <= 1:
            self.views += 2 if isinstance(entry.given, Reading) else 1


class Run(Protocol):
    """Views by number, however they come about."""

    @property
    def over(self) -> bool:
        """Whether there are no more than have been made."""

    @property
    def failure(self) -> StepError | None:
        """What the run failed by, once what comes before it has been asked for."""

    def __len__(self) -> int:
        """How many there are so far."""

    def view(self, number: int) -> View | None:
        """View `number`, or None where the run is over before it."""


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
        self.over = False  # whether the last view has been come to

    def __len__(self) -> int:
        """How many views have been computed so far."""
        return len(self._seen)

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
                self.over = True
                return None
            self._seen.append(following)
        return self._seen[number]
