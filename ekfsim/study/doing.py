"""Doing a plan: every block that the journal lacks, kept as it is done."""

from collections.abc import Callable

from ekfsim.study.engines import Engine
from ekfsim.study.journal import Journal
from ekfsim.study.plan import Plan, Task
from ekfsim.study.results import Result
from ekfsim.study.tally import Tally


def do(plan: Plan, journal: Journal, engine: Engine, done: Callable[[Task, Tally], None]) -> None:
    """Do what is not done yet; `done` hears of each block once it is safe."""
    missing = (task for task in plan.tasks() if task not in journal)
    for task, tally in engine(plan, missing):
        journal.add(task, tally)
        done(task, tally)


def results_of(plan: Plan, journal: Journal) -> list[Result]:
    """What is said of each case once all is done."""
    return [Result(case, journal.total(plan, number)) for number, case in enumerate(plan.cases)]
