"""How far a study or a grader has come, on a terminal; what is kept of it where it ends early."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ekfsim.cli.program.process import heed, part_with, say
from ekfsim.errors import EkfsimError, StepError

if TYPE_CHECKING:
    from ekfsim.student.grading.scores import Grade
    from ekfsim.study.plan import Plan, Task
    from ekfsim.study.results import Result
    from ekfsim.study.running.engines import Engine
    from ekfsim.study.running.journal import Journal
    from ekfsim.study.tally import Tally


@contextmanager
def progress(plan: "Plan", journal: "Journal") -> Iterator[Callable[["Task", "Tally"], None]]:
    """A bar on standard error where that is a terminal,
    with the share of runs that are lost so far.
    """
    total = plan.blocks * len(plan.cases)
    runs = lost = 0
    hidden = not sys.stderr.isatty()
    with click.progressbar(
        length=total,
        label="blocks",
        file=sys.stderr,
        hidden=hidden,
        item_show_func=lambda told: told,
    ) as bar:

        def done(task: "Task", tally: "Tally") -> None:
            nonlocal runs, lost
            heed()
            runs, lost = runs + tally.runs, lost + sum(tally.lost_from.values())
            bar.update(1, f"{100 * lost / runs:.3g} % lost")

        if not hidden:
            for task in plan.tasks():
                if task in journal:
                    done(task, journal.tally(task))
        try:
            yield done
        except EkfsimError as failure:
            left = kept(journal, total, isinstance(failure, StepError))
            failure.args = ("; ".join(filter(None, (str(failure), left))),)
            raise
        except (KeyboardInterrupt, SystemExit):
            part_with(kept(journal, total))
            raise


@contextmanager
def blocks_bar(total: int, label: str = "blocks") -> Iterator[Callable[[object, object], None]]:
    """A bar for blocks of which none is kept."""
    with click.progressbar(
        length=total, label=label, file=sys.stderr, hidden=not sys.stderr.isatty()
    ) as bar:

        def done(task: object, found: object) -> None:
            heed()
            bar.update(1)

        yield done


@contextmanager
def submissions_bar(total: int, work: Path) -> "Iterator[Callable[[Grade | None], None]]":
    """A bar for submissions; what is kept of them where it ends early."""
    graded = 0
    with click.progressbar(
        length=total, label="submissions", file=sys.stderr, hidden=not sys.stderr.isatty()
    ) as bar:

        def done(grade: "Grade | None") -> None:
            nonlocal graded
            heed()
            graded += 1
            bar.update(1)

        try:
            yield done
        except (KeyboardInterrupt, SystemExit):
            told = f"{graded} of {total} submissions are graded and kept in {work}"
            part_with(f"{told}; the same command goes on with the rest" if graded else "")
            raise


def kept(journal: "Journal", total: int, failed: bool = False) -> str:
    """What is kept of a study that ends early, and the way on.

    failed : in the code of a filter, which is another once it is mended
    """
    if not len(journal):
        return ""
    if failed:
        return (
            f"{len(journal)} of {total} blocks are kept in {journal.path.parent}, made by this "
            "code: once it is mended, begin anew with --force"
        )
    if len(journal) == total:
        return f"all blocks are kept in {journal.path.parent}, --resume goes on with the tables"
    return (
        f"{len(journal)} of {total} blocks are kept in {journal.path.parent}, "
        "--resume goes on with the rest"
    )


def study_into(
    plan: "Plan", engine: "Engine", out: Path, resume: bool, force: bool
) -> "list[Result]":
    """Do a study, each block safe as soon as it is done, and write its tables and pictures."""
    from ekfsim.views.picture.look import get_ready

    get_ready()
    from ekfsim.files.results.writing import refuse_existing_folder
    from ekfsim.study.running.doing import do, results_of
    from ekfsim.study.running.journal import journal_in, remove
    from ekfsim.views.study.folder import FILES, copies_in, write_study

    refuse_existing_folder(out, *FILES, *copies_in(out, plan.filters), force=force)
    partial = out.with_name(f"{out.name}.partial")
    with journal_in(partial, plan, resume, force) as journal:
        if resume and not len(journal):
            say(
                f"{partial}: nothing is kept there to go on with; "
                "this is a study from the beginning"
            )
        with progress(plan, journal) as done:
            do(plan, journal, engine, done)
            results = results_of(plan, journal)
            write_study(plan, results, out, force)
    remove(partial)
    return results
