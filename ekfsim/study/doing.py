"""Doing a plan: every block that the journal lacks, kept as it is done; or all blocks, where
nothing is kept.
"""

from collections.abc import Callable, Iterable
from typing import Any, Generic, Protocol, Self, TypeVar

from ekfsim.study.engines import Engine, Work
from ekfsim.study.journal import Journal
from ekfsim.study.plan import Plan, Task
from ekfsim.study.results import Result
from ekfsim.study.tally import Tally


class Sum(Protocol):
    """What of two blocks can be put together."""

    def __add__(self, other: Any, /) -> Self:
        """What becomes of the runs of both."""


S = TypeVar("S", bound=Sum)


def do(plan: Plan, journal: Journal, engine: Engine, done: Callable[[Task, Tally], None]) -> None:
    """Do what is not done yet; `done` hears of each block once it is safe."""
    missing = (task for task in plan.tasks() if task not in journal)
    for task, tally in engine(plan, missing):
        journal.add(task, tally)
        done(task, tally)


def results_of(plan: Plan, journal: Journal) -> list[Result]:
    """What is said of each case once all is done."""
    return [Result(case, journal.total(plan, number)) for number, case in enumerate(plan.cases)]


def unkept(plan: Plan, engine: Engine, done: Callable[[Task, Tally], None]) -> list[Result]:
    """The same at once and without a journal, for a first look."""
    found = [_InOrder[Tally]() for _ in plan.cases]
    for task, made in engine(plan, plan.tasks()):
        done(task, made)
        found[task.case].add(task.block, made)
    return [Result(case, blocks.total()) for case, blocks in zip(plan.cases, found, strict=True)]


def total(
    work: Work[S], tasks: Iterable[Task], engine: Engine, done: Callable[[Task, S], None]
) -> S:
    """All blocks of one case together, without a journal."""
    found = _InOrder[S]()
    for task, made in engine(work, tasks):
        done(task, made)
        found.add(task.block, made)
    return found.total()


class _InOrder(Generic[S]):
    """Blocks put together in their order, in whichever they come: sums of floating numbers depend
    on it.
    """

    def __init__(self) -> None:
        self._found: S | None = None
        self._early: dict[int, S] = {}
        self._next = 0

    def add(self, block: int, made: S) -> None:
        """Put a block to those before it, once all of them are there."""
        self._early[block] = made
        while self._next in self._early:
            following = self._early.pop(self._next)
            self._found = following if self._found is None else self._found + following
            self._next += 1

    def total(self) -> S:
        """All of them."""
        assert self._found is not None
        assert not self._early
        return self._found
