"""The commands for students and who teaches them: mutants, worksheet."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Result, Seed, Share, Whole
from ekfsim.cli.program.options import EXPLAIN, FORCE, MOST, MOST_RUNS, scene_options
from ekfsim.cli.program.process import heed, width
from ekfsim.errors import RunError, UsageError
from ekfsim.printable import in_a_line, shown

if TYPE_CHECKING:
    from ekfsim.scene import Scene
    from ekfsim.student.mistakes.mistake import Mistake
    from ekfsim.study.results import Result as Studied


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
    from ekfsim.student.exposing.statistics import without_mistake
    from ekfsim.student.exposing.table import write_exposed
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
    right, statistics = None, dict["Mistake", "Studied"]()
    if runs is not None:
        if scenes[0].log is not None:
            raise UsageError(
                f"--runs: {scenes[0].commands_source} is a recording, which is one run"
            )
        right, statistics = without_mistake(scenes[0], runs), with_each_mistake(scenes[0], runs)
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


def with_each_mistake(scene: "Scene", runs: int) -> "dict[Mistake, Studied]":
    """What statistics of many runs say of each known mistake."""
    from ekfsim.student.exposing.statistics import with_mistake
    from ekfsim.student.mistakes.known import KNOWN

    found = {}
    with click.progressbar(
        KNOWN, label="mistakes", file=sys.stderr, hidden=not sys.stderr.isatty()
    ) as bar:
        for mistake in bar:
            heed()
            found[mistake] = with_mistake(scene, mistake, runs)
    return found
