"""The commands that draw a run: render, plot."""

import sys
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Area, Result, StepNumber, Whole
from ekfsim.cli.program.options import DPI, FORCE, SIZE, scene_options
from ekfsim.cli.program.process import heed, say, warn
from ekfsim.errors import UsageError
from ekfsim.printable import in_a_line

if TYPE_CHECKING:
    from ekfsim.scene import Scene
    from ekfsim.views.picture.look import Look


@click.command()
@scene_options
@click.option(
    "--out",
    "-o",
    type=Result(),
    required=True,
    help="A folder for PNG files, step-0013.png and before it step-0013-beam.png, or the name of "
    "a .gif, of an .mp4, or of an .html: one page that plays in a browser. With --step, of a .png, "
    "an .svg or a .pdf.",
)
@click.option("--every", type=Whole(min=1), default=1, metavar="N", help="Only every N-th picture.")
@click.option(
    "--conditional",
    is_flag=True,
    help="Draw the ellipse for the heading at either edge of its cone, too.",
)
@click.option(
    "--step",
    type=StepNumber(),
    metavar="N",
    help="One picture, of this step; of a reading 13 is the revised estimate, 13b the beam.",
)
@click.option("--follow", is_flag=True, help="Show a part of the world that goes with the robot.")
@click.option(
    "--zoom",
    type=Area(),
    metavar="X,Y,W,H",
    help="Show this part of the world: the lower left corner, the width and the height, in m.",
)
@click.option(
    "--strip", is_flag=True, help="Draw the curves of `plot` beneath each picture, with a cursor."
)
@click.option(
    "--why", "explained", is_flag=True, help="On a page, tell why the run was lost, too (key w)."
)
@SIZE
@DPI
@FORCE
def render(
    out: Path, every: int, conditional: bool, step: tuple[int, bool] | None, follow: bool,
    zoom: tuple[float, float, float, float] | None, size: tuple[int, int] | None, dpi: int,
    strip: bool, explained: bool, force: bool, confidence: float, **chosen: Any,
) -> None:  # fmt: skip
    """Draw every step of COMMANDS into files, or one step."""
    from ekfsim.views.picture.look import Look, Paper, get_ready

    get_ready()
    paper = Paper(size, dpi)
    paper.check()
    _refuse_together(out, every, step is not None, follow, zoom is not None, paper != Paper())
    if out.suffix.lower() == ".html":
        look = Look(confidence, conditional)
        return write_page(scene_of(**chosen), out, look, every, force, explained)
    if explained:
        raise UsageError("--why: stands on a page; name an .html, or see `ekfsim why -o why.png`")
    from ekfsim.localization import play as steps_of
    from ekfsim.views.curves.series import Series
    from ekfsim.views.film import animation, one_step
    from ekfsim.views.picture.extent import scope as scopes
    from ekfsim.views.picture.extent.limits import Limits
    from ekfsim.views.picture.written.lettering import boxes
    from ekfsim.views.playback.kept import kept
    from ekfsim.views.playback.playback import Tally, together
    from ekfsim.views.words.captions import texts

    scene, tally = scene_of(**chosen), Tally()
    warn(boxes(texts(scene)))
    first, *others = scene.alone()
    names = scene.filter, *scene.beside
    curves = [Series(name) for name in scene.watching] if strip else []
    takers = [[run.take] for run in curves] or [[] for _ in names]
    takers[0].append(tally.write)
    runs = map(kept, map(steps_of, scene.alone()), takers)
    with redirect_stderr(StringIO()):  # what a filter prints it prints again as it is drawn
        scope = scopes.of_all(scene, runs, confidence, follow)
    scope = scope if zoom is None else scopes.showing(Limits(*zoom))
    views, look = (
        together(steps_of(first), map(steps_of, others), names),
        Look(confidence, conditional),
    )
    if step is not None:
        view = one_step.find(views, *step)
        one_step.render(view, scene, scope, out, look=look, paper=paper, strip=curves, force=force)
        return click.echo(f"{in_a_line(out)}: step {view.step.entry.index}")
    pictures = animation.number_of_pictures(tally.views, every)
    with click.progressbar(
        length=pictures, label="pictures", file=sys.stderr, hidden=not sys.stderr.isatty()
    ) as bar:

        def made_one(made: int) -> None:
            heed()
            bar.update(1)

        animation.render(
            views, scene, scope, out, look=look, paper=paper, strip=curves,
            every=every, force=force, progress=made_one,
        )  # fmt: skip
    click.echo(f"{in_a_line(out)}: {pictures} {'picture' if pictures == 1 else 'pictures'}")


def _refuse_together(
    out: Path, every: int, one: bool, follow: bool, zoom: bool, shaped: bool
) -> None:
    """Raises UsageError where options do not go together."""
    if follow and zoom:
        raise UsageError("--follow and --zoom both say what is shown; choose one")
    if one and every > 1:
        raise UsageError("--step draws one picture, and --every leaves out some of many")
    if one:
        from ekfsim.views.film.still import KINDS

        if out.suffix.lower() not in KINDS:
            raise UsageError(f"{out}: --step draws one picture; name a .png, an .svg or a .pdf")
    if out.suffix.lower() == ".html" and (follow or zoom or shaped):
        raise UsageError(
            f"{out}: a page fits its window, and is not drawn with "
            "--follow, --zoom, --size or --dpi"
        )


def write_page(
    scene: "Scene", out: Path, look: "Look", every: int, force: bool, explained: bool = False
) -> None:
    """Write the page that plays a scene, and tell what it holds. explained : tell why it was lost,
    too
    """
    from ekfsim.files.results.writing import refuse_existing
    from ekfsim.views.page.writing import write

    refuse_existing(out, force)  # before anything takes long
    reason = ""
    if explained:
        from ekfsim.views.why.answer import answer
        from ekfsim.views.why.asked import runs_for
        from ekfsim.why import explain

        one = scene.alone()[0]
        reason = answer(explain(one, runs_for(one), heard=lambda *done: heed()))
    made = write(scene, out, look, every, force, heed, reason)
    if made.left_out:
        say(f"{in_a_line(out)}: {made.left_out}")
    click.echo(f"{in_a_line(out)}: {made.held} {'view' if made.held == 1 else 'views'}")


@click.command(short_help="Plot errors, NIS and NEES of COMMANDS over its steps.")
@scene_options
@click.option(
    "--out", "-o", type=Result(), required=True, help="The name of a .png, an .svg or a .pdf."
)
@SIZE
@DPI
@FORCE
def plot(
    out: Path, size: tuple[int, int] | None, dpi: int, force: bool, confidence: float, **chosen: Any
) -> None:
    """Plot errors with their ±2σ, NIS and NEES with their bounds over the steps of COMMANDS.

    Several filters share one picture. Events and readings that were not used are marked, and where
    a filter is lost for good. Of a log without a truth there are innovations and NIS alone.
    """
    from ekfsim.views.picture.look import Paper, get_ready

    get_ready()
    from ekfsim.localization import play as steps_of
    from ekfsim.views.curves.panels import remarks
    from ekfsim.views.curves.plot import write
    from ekfsim.views.curves.series import Series
    from ekfsim.views.film.still import refuse
    from ekfsim.views.picture.written.lettering import boxes
    from ekfsim.views.words.captions import texts

    scene = scene_of(**chosen)
    refuse(out, force)
    warn(boxes(texts(scene)))
    runs = []
    for one, name in zip(scene.alone(), scene.watching, strict=True):
        runs.append(Series(name))
        for step in steps_of(one):
            heed()
            runs[-1].take(step)
    write(runs, scene, out, Paper(size, dpi), confidence, force)
    for remark in remarks(runs):
        say(remark)
    click.echo(f"{in_a_line(out)}: {', '.join(map(in_a_line, scene.watching))} over {runs[0].span}")
