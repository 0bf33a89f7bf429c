"""The command that holds what a student wrote against a reference: diff."""

import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Source, Whole
from ekfsim.cli.program.options import GATE, GUARD, MOST_RUNS, PLAIN, PLAYED, SET, with_options
from ekfsim.cli.program.process import heed, warn
from ekfsim.errors import RunError, UsageError
from ekfsim.printable import shown

if TYPE_CHECKING:
    from ekfsim.scene import Scene

T = TypeVar("T")
OPTIONS: tuple[Callable[..., Any], ...] = (  # whose filter, beside which, over which runs
    *PLAYED,
    click.option(
        "--filter",
        "filter_name",
        metavar="FILE.py[:NAME]",
        help="The filter of one's own, or package.module:NAME.",
    ),
    click.option(
        "--csv",
        type=Source(),
        metavar="FILE",
        help="In place of it: a table of results that a program in another language wrote "
        "(index, x, y, theta, P_xx, P_xy, …).",
    ),
    click.option(
        "--narrative",
        type=Source(),
        metavar="FILE",
        help="Or what a program printed in the assignment's format, number by number.",
    ),
    click.option(
        "--against",
        metavar="NAME",
        default="ekf",
        show_default=True,
        help="What it is held against: a built-in filter, or FILE.py.",
    ),
    click.option(
        "--runs",
        type=Whole(1, MOST_RUNS),
        metavar="N",
        default=1,
        show_default=True,
        help="How many runs, from --run on.",
    ),
    click.option(
        "--provided",
        metavar="NAME,…",
        help="The only equations of motion and sensor that the filter may ask for, e.g. f,h.",
    ),
    GATE,
    GUARD,
    SET,
    PLAIN,
)


def diff_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a comparison step by step."""
    return with_options(command, OPTIONS)


@click.command(short_help="Find the first wrong number of a filter of one's own.")
@diff_options
def diff(
    filter_name: str | None, csv: str | None, narrative: str | None, against: str, runs: int,
    provided: str | None, **chosen: Any,
) -> None:  # fmt: skip
    """Hold a filter of one's own against the built-in one, step by step, each from what it believed
    itself: the first wrong number, and which mistake it comes of. --csv and --narrative do the same
    with what a program in another language wrote.

    Exit status 0 where both are equal, 1 where they differ or the code fails, 2 for wrong usage.
    """
    from ekfsim.files.scenes.settings import filter_in
    from ekfsim.filters.place import label
    from ekfsim.provenance import told_in_a_line
    from ekfsim.student.comparing.sides import comparable

    named = [name for name in (filter_name, csv, narrative) if name is not None]
    if len(named) != 1:
        what = "one of --filter, --csv and --narrative"
        raise UsageError(
            f"diff: there is nothing to compare; name {what}"
            if not named
            else f"diff: only {what} can be compared at once"
        )
    if filter_name is None and (runs > 1 or provided is not None):
        option = "--runs" if runs > 1 else "--provided"
        raise UsageError(f"{option}: a file is of one run, and asks for no equations; leave it out")
    reference = comparable(filter_in(against, "--against"), "--against")
    scene = scene_of(**chosen)
    made = told_in_a_line(replace(scene, filter=label(reference)))
    if filter_name is not None:
        _diff_filter(scene, filter_name, reference, runs, provided)
    elif csv is not None:
        _diff_table(scene, csv, reference, made)
    elif narrative is not None:
        _diff_narrative(scene, narrative, reference, made)


def _diff_filter(
    scene: "Scene", filter_name: str, reference: str, runs: int, provided: str | None
) -> None:
    from ekfsim.files.scenes.settings import filter_in
    from ekfsim.filters.place import label
    from ekfsim.provenance import told_in_a_line
    from ekfsim.student.comparing.found import found as found_in
    from ekfsim.student.comparing.sides import caller_of, comparable, runs_of
    from ekfsim.student.own.handed import provided_in
    from ekfsim.views.student.difference import Sides, told

    name = comparable(filter_in(filter_name, "--filter"), "--filter")
    scene = replace(scene, filter=name, beside=())
    caller = caller_of(scene, None if provided is None else provided_in(provided, "--provided"))
    found = found_in(heeded(runs_of(scene, caller, reference, runs)))
    if not found.steps and found.fault is None:
        raise UsageError(f"{scene.commands_source}: has no move and no reading to be compared")
    made = f"{told_in_a_line(scene)}, runs {runs}, against {label(reference)}"
    sides = Sides(label(name), label(reference), made, scene.world.system == "classroom")
    click.echo(shown(told(found, sides)), nl=False)
    if found.fault is not None:
        raise found.fault
    if not found.equal:
        sys.exit(RunError.status)


def _diff_table(scene: "Scene", csv: str, reference: str, made: str) -> None:
    from ekfsim.filters.place import label
    from ekfsim.student.printed.held import held_table
    from ekfsim.views.student.difference import Sides, told

    held = held_table(scene, Path(csv), reference)
    warn(held.remarks)
    click.echo(shown(told(held.found, Sides(csv, label(reference), made, printed=True))), nl=False)
    if held.found.fault is not None:
        raise held.found.fault
    if not held.found.equal:
        sys.exit(RunError.status)


def _diff_narrative(scene: "Scene", narrative: str, reference: str, made: str) -> None:
    from ekfsim.student.printed.held import held_narrative
    from ekfsim.views.student.narrative import told

    found = held_narrative(scene, Path(narrative), reference)
    click.echo(shown(told(found, made)), nl=False)
    if found.wrong:
        sys.exit(RunError.status)


def heeded(runs: Iterable[T]) -> Iterator[T]:
    """The same, ended by a signal between two."""
    for run in runs:
        heed()
        yield run
