"""Doing a plan: every block that the journal lacks, kept as it is done; or all blocks, where
nothing is kept.
"""

import functools
import itertools
import operator
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Protocol, Self, TypeVar

from ekfsim.study.plan import Plan, Task
from ekfsim.study.results import Result
from ekfsim.study.running.engines import Engine, Work
from ekfsim.study.running.journal import Journal
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
    blocks = in_order(plan.tasks(), heard(engine(plan, plan.tasks()), done))
    totals = (
        functools.reduce(operator.add, (tally for _, tally in of_case))
        for _, of_case in itertools.groupby(blocks, key=lambda block: block[0].case)
    )
    return [Result(case, tally) for case, tally in zip(plan.cases, totals, strict=True)]


def total(
    work: Work[S], tasks: Iterable[Task], engine: Engine, done: Callable[[Task, S], None]
) -> S:
    """All blocks of one case together, without a journal."""
    asked, awaited = itertools.tee(tasks)
    blocks = in_order(awaited, heard(engine(work, asked), done))
    return functools.reduce(operator.add, (made for _, made in blocks))


def heard(
    blocks: Iterable[tuple[Task, S]], done: Callable[[Task, S], None]
) -> Iterator[tuple[Task, S]]:
    """Blocks as they are done; `done` hears of each."""
    for task, made in blocks:
        done(task, made)
        yield task, made


def in_order(tasks: Iterable[Task], blocks: Iterable[tuple[Task, S]]) -> Iterator[tuple[Task, S]]:
    """Blocks in the order of their tasks, in whichever they come: sums of floating numbers depend
    on it.
    """
    tasks, early = iter(tasks), dict[Task, S]()
    awaited = next(tasks, None)
    for task, made in blocks:
        early[task] = made
        while awaited in early:
            yield awaited, early.pop(awaited)
            awaited = next(tasks, None)
