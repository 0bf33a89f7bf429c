"""The command that says why a run was lost: why."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Result, Whole
from ekfsim.cli.program.options import FORCE, MOST_RUNS, scene_options
from ekfsim.cli.program.process import heed, part_with, shown, width
from ekfsim.errors import UsageError

if TYPE_CHECKING:
    from ekfsim.why.records import Explanation

MOST_REPLAYS = 10**6
FEWEST_RUNS = 100  # of fewer no share tells one cause from another


@click.command(short_help="Say why the run of COMMANDS was lost, and what cures it.")
@scene_options
@click.option(
    "--runs", type=Whole(FEWEST_RUNS, MOST_RUNS), metavar="N",
    help="How many runs of the seed stand behind the name and the shares: 1000 where it is not "
    "said, and 100 of particles or of a filter of your own.",
)  # fmt: skip
@click.option(
    "--budget", type=Whole(1, MOST_REPLAYS), metavar="N",
    help="How many times the run is played again, at most: 400 where it is not said, and fewer of "
    "a long run or a slow filter.",
)  # fmt: skip
@click.option("--csv", type=Result(), metavar="FILE", help="Write every change that was tried.")
@click.option(
    "--out", "-o", type=Result(), metavar="FILE",
    help="Draw the lost run and the cured one over each other from the step where they part: a "
    ".png, an .svg or a .pdf.",
)  # fmt: skip
@FORCE
def why(
    runs: int | None, budget: int | None, csv: Path | None, out: Path | None, force: bool,
    confidence: float, **chosen: Any,
) -> None:  # fmt: skip
    """Say why the run of COMMANDS was lost, and what cures it.

    The very same draws are played again with one thing put right at a time: each number that the
    filter is told, each fault, each wall of its map, each reading, each move. What cures it is the
    cause, and many runs say how often.
    """
    part_with()
    scene = scene_of(**chosen)
    if scene.beside:
        raise UsageError("--filter: one filter is asked why; name one")
    if out is not None:
        from ekfsim.views.picture.look import get_ready

        get_ready()
        from ekfsim.views.film.still import refuse

        refuse(out, force)
    if csv is not None:
        from ekfsim.files.results.writing import refuse_existing

        refuse_existing(csv, force)
    from ekfsim.views.why.answer import answer
    from ekfsim.views.why.asked import runs_for
    from ekfsim.why import explain

    with replays_bar() as heard:
        found = explain(scene, runs or runs_for(scene), budget, heard)
    if csv is not None:
        write_table(found, csv, force)
    if out is not None:
        from ekfsim.views.why.picture import draw_why

        draw_why(found, out, confidence, force)
    click.echo(shown(answer(found, width())), nl=False)
    heed()  # what there was is told, and that it was cut short


def write_table(found: "Explanation", path: Path, force: bool) -> None:
    """Write the changes that were tried."""
    from ekfsim.files.results.writing import whole_text
    from ekfsim.views.why.tried import write_csv

    with whole_text(path, force) as file:
        write_csv(file, found)


@contextmanager
def replays_bar() -> Iterator[Callable[[int, int, str], None]]:
    """A bar on standard error where that is a terminal: how many of the replays are done, then how
    far many runs have come.
    """
    from ekfsim.why.records import REPLAYS

    with click.progressbar(
        length=1, label=REPLAYS, file=sys.stderr, hidden=not sys.stderr.isatty()
    ) as bar:

        def heard(done: int, of: int, what: str) -> None:
            heed()
            if bar.label != what:
                bar.label, bar.pos = what, 0
            bar.length = of
            bar.update(done - bar.pos)

        yield heard
