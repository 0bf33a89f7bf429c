"""The commands for students and who teaches them: diff, mutants, worksheet."""

import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ekfsim.cli.asked import scene_of
from ekfsim.cli.kinds import Result, Seed, Share, Whole
from ekfsim.cli.options import EXPLAIN, FORCE, MOST, MOST_RUNS, diff_options, scene_options
from ekfsim.cli.process import heed, warn, width
from ekfsim.errors import RunError, UsageError
from ekfsim.printable import in_a_line, shown

if TYPE_CHECKING:
    from ekfsim.scene import Scene

T = TypeVar("T")


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


@click.command(short_help="Write the narrative of COMMANDS with gaps to fill in.")
@scene_options
@click.option("--out", "-o", type=Result(), required=True, metavar="SHEET.md",
              help="The sheet; beside it SHEET-solution.md is written.")  # fmt: skip
@click.option(
    "--blanks",
    type=Share(),
    default=0.3,
    show_default=True,
    help="How much is left out of what can be calculated.",
)
@EXPLAIN
@FORCE
def worksheet(
    out: Path, blanks: float, explain: bool, force: bool, confidence: float, **chosen: Any
) -> None:
    """Write the narrative of COMMANDS with gaps to fill in, and the solution beside it.

    Seed and run choose the gaps, too: --run K is another sheet.
    """
    from ekfsim.files.results.writing import whole_text
    from ekfsim.views.worksheet.sheets import sheets

    solution = out.with_name(f"{out.stem}-solution{out.suffix}")
    made = sheets(scene_of(**chosen), blanks, confidence, explain)
    with whole_text(out, force) as sheet, whole_text(solution, force) as beside:
        sheet.write(made.sheet)
        beside.write(made.solution)
    click.echo(in_a_line(f"{out}: {made.gaps} gaps; {solution}: what belongs in them"))


@click.command(short_help="Tell which known mistakes COMMANDS expose, by which number.")
@click.argument("commands", nargs=-1, required=True)
@click.option("--seed", type=Seed(), help="In place of the files' seeds.")
@click.option("--run", "run_number", type=Whole(0, MOST), default=0, help="Which run of the seed.")
@click.option(
    "--runs",
    type=Whole(1, MOST_RUNS),
    metavar="N",
    help="What statistics of N runs would see of each, too (of one COMMANDS).",
)
@click.option("--csv", type=Result(), metavar="FILE", help="Write a table, a row a mistake.")
@click.option(
    "--all", "all_of_them", is_flag=True, help="Exit status 1 where one is exposed by none."
)
@FORCE
def mutants(
    commands: tuple[str, ...], seed: int | None, run_number: int, runs: int | None,
    csv: Path | None, all_of_them: bool, force: bool,
) -> None:  # fmt: skip
    """Tell which known mistakes of students' filters COMMANDS expose: the first step at which a
    filter with the mistake has other numbers than the right one, and which.

    Of several COMMANDS a matrix is told: a row a mistake, a column a file.
    """
    from ekfsim.files.results.writing import refuse_existing, whole_text
    from ekfsim.student.exposing.exposed import exposed
    from ekfsim.student.exposing.statistics import with_mistake, without_mistake
    from ekfsim.student.exposing.table import write_exposed
    from ekfsim.student.mistakes.known import KNOWN
    from ekfsim.views.student.exposing import first_of, of_one, of_several

    if runs is not None and len(commands) > 1:
        raise UsageError("--runs: name one COMMANDS")
    if csv is not None:
        refuse_existing(csv, force)
    scenes = [scene_of(name, seed=seed, run_number=run_number) for name in commands]
    found = []
    for scene in scenes:
        heed()
        found.append(exposed(scene))
    right, statistics = None, {}
    if runs is not None:
        if scenes[0].log is not None:
            raise UsageError(
                f"--runs: {scenes[0].commands_source} is a recording, which is one run"
            )
        right = without_mistake(scenes[0], runs)
        with click.progressbar(
            KNOWN, label="mistakes", file=sys.stderr, hidden=not sys.stderr.isatty()
        ) as bar:
            for mistake in bar:
                heed()
                statistics[mistake] = with_mistake(scenes[0], mistake, runs)
    if csv is not None:
        with whole_text(csv, force) as file:
            write_exposed(file, scenes, found, statistics)
    told = (
        of_one(commands[0], found[0], right, statistics, width())
        if len(found) == 1
        else of_several(commands, found, width())
    )
    click.echo(shown(told), nl=False)
    together = (first_of(rows) for rows in zip(*found, strict=True))
    missed = [one.mistake.name for one in together if one.possible and one.first is None]
    if all_of_them and missed:
        raise RunError(f"not exposed: {', '.join(missed)}")
