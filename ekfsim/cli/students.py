"""The commands for students and who teaches them: worksheet."""

from pathlib import Path
from typing import Any

import click

from ekfsim.cli.asked import scene_of
from ekfsim.cli.kinds import Result, Share
from ekfsim.cli.options import EXPLAIN, FORCE, scene_options
from ekfsim.printable import in_a_line


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
