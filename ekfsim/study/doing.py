"""Doing a plan: every block that the journal lacks, kept as it is done; or all blocks, where nothing is kept."""

from collections.abc import Callable, Iterable
from typing import Any, Protocol, Self, TypeVar

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


def total(work: Work[S], tasks: Iterable[Task], engine: Engine, done: Callable[[Task, S], None]) -> S:
    """All blocks of one case together, at once and without a journal.

    They are put together in their order, in whichever they come: sums of floating numbers depend on it.
    """
    found: S | None = None
    early, number = dict[int, S](), 0
    for task, made in engine(work, tasks):
        done(task, made)
        early[task.block] = made
        while number in early:
            following = early.pop(number)
            found, number = following if found is None else found + following, number + 1
    assert found is not None
    assert not early
    return found
