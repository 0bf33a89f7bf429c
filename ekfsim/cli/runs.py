"""The commands that play one run: play, render, plot, run, record."""

import sys
from contextlib import ExitStack, redirect_stderr
from functools import partial
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import files_of, scene_of
from ekfsim.cli.program.kinds import Area, Pace, Result, StepNumber, Whole, Word
from ekfsim.cli.program.options import DPI, EXPLAIN, FORCE, SIZE, scene_options
from ekfsim.cli.program.process import heed, say, warn
from ekfsim.errors import UsageError
from ekfsim.printable import in_a_line
from ekfsim.views.terminal.keys.help import HELP

if TYPE_CHECKING:
    from ekfsim.scene import Scene
    from ekfsim.views.picture.look import Look


@click.command(
    help=f"Step through COMMANDS with single keys.\n\n\b\n{HELP}",
    short_help="Step through COMMANDS with single keys.",
)
@scene_options
@click.option("--show", type=Word(["auto", "window", "image", "text", "files"]),
              default="auto", show_default=True,
              help="Draw in a window, as an image in a terminal that has them (kitty, iTerm2, "
                   "sixel), as text in any, or into one file rewritten in place. auto: in the "
                   "first that there is of window, image and text.")  # fmt: skip
@click.option("--out", "-o", type=Result(), default=Path("out"), show_default=True,
              help="Folder for the pictures of --show files and of the key s.")  # fmt: skip
@click.option(
    "--conditional",
    is_flag=True,
    help="Draw the ellipse for the heading at either edge of its cone, too.",
)
@click.option("--auto", type=Pace(), metavar="SECONDS",
              help="Go on by itself, a view every so many seconds.")  # fmt: skip
@click.option("--watch", is_flag=True,
              help="Read commands, world and a filter FILE.py again whenever they are saved, and "
                   "stay at the step.")  # fmt: skip
@EXPLAIN
@FORCE
def play(
    show: str, out: Path, conditional: bool, auto: float | None, watch: bool, explain: bool,
    force: bool, confidence: float, **chosen: Any
) -> None:  # fmt: skip
    """Begin at the first view; the keys do the rest."""
    from ekfsim.views.picture.look import Look
    from ekfsim.views.terminal.interactive import play_interactively

    scene, look, watching = scene_of(**chosen), Look(confidence, conditional), None
    if watch:
        from ekfsim.views.terminal.watching import Watch

        files = partial(files_of, chosen["commands"])
        watching = Watch(scene, partial(scene_of, **chosen), files)
    play_interactively(scene, show, out, look, force, explain, auto, watching)


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
        reason = answer(explain(one, runs_for(one), heard=lambda done, budget: heed()))
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


@click.command()
@scene_options
@click.option("--trace", type=Result(), help="Write every number of every step, as JSON lines.")
@click.option(
    "--tum", type=Result(), help="Folder for estimate.tum and, where it is known, truth.tum."
)
@click.option("--csv", type=Result(), help="Write a flat table.")
@click.option("--summary", type=Result(), help="Write the closing summary as JSON.")
@click.option("--quiet", "-q", is_flag=True, help="Only the closing summary, no narrative.")
@EXPLAIN
@FORCE
def run(
    trace: Path | None, tum: Path | None, csv: Path | None, summary: Path | None, quiet: bool,
    explain: bool,
    force: bool, confidence: float, **chosen: Any,
) -> None:  # fmt: skip
    """Narrate COMMANDS from the first step to the last, and sum up."""
    from itertools import zip_longest

    from ekfsim.diagnostics.summary import Summary
    from ekfsim.files.results.outputs import Outputs
    from ekfsim.filters.place import is_smoothed
    from ekfsim.localization import play as steps_of
    from ekfsim.smoothing.shares import Shares
    from ekfsim.views.playback.kept import kept
    from ekfsim.views.playback.playback import together
    from ekfsim.views.words.closing import conclude_all
    from ekfsim.views.words.narrative import narrate

    scene = scene_of(**chosen)
    alone, outputs = scene.alone(), Outputs(trace, tum, csv, summary, force)
    results = [Summary.of(one) for one in alone]
    smoothed = any(map(is_smoothed, scene.watching))
    shares = [Shares() for _ in alone] if smoothed else []
    with ExitStack() as stack:
        runs = []
        every = zip_longest(alone, results, outputs.for_each(scene), shares)
        for one, result, files, share in every:
            sinks = stack.enter_context(files.open(one, confidence, result))
            if (unknown := files.unknown_truth(one)) is not None:
                say(f"{unknown}: left out, for the log does not tell the truth")
            takers = [*(sink.write for sink in sinks), *([share.take] if share else [])]
            runs.append(kept(result.following(steps_of(one)), takers))
        for view in together(runs[0], runs[1:], (scene.filter, *scene.beside)):
            heed()
            if not quiet:
                sys.stdout.write(narrate(view, scene, confidence, explain))
    told = conclude_all(scene, results, quiet, view.apart, shares)
    (sys.stderr if outputs.on_stdout() else sys.stdout).write(told)


@click.command(short_help="Write the simulated run of COMMANDS as a recorded log.")
@scene_options
@click.option(
    "--out", "-o", type=Result(), required=True, help="A folder for the files of the log."
)
@click.option(
    "--truth",
    "with_truth",
    is_flag=True,
    help="Of a classroom, write the true poses and what made the log, too.",
)
@click.option(
    "--format",
    type=Word(["log", "own", "mower", "gnss", "pylon", "pioneer", "classroom"]),
    help="log (usual): tables with named columns, for every robot that drives. own, or its name "
    "(mower, gnss, pylon, pioneer): as the robot's own logs are. A classroom has its own alone.",
)
@FORCE
def record(
    out: Path, force: bool, with_truth: bool, format: str | None, confidence: float, **chosen: Any
) -> None:
    """Write the simulated run of COMMANDS as the files of a recorded log.

    Of a robot that drives they are a folder of the format log: motion.csv, readings.csv, truth.csv,
    landmarks.csv where there are some, and world.yaml with all as the filter is told. Run upon it,
    the filter makes the same numbers.

    Of a classroom they are what a program in any language needs: the odometry and the ranges, and
    the map and the ratios as the filter is told them. Without --truth nothing in them tells the
    scene, the seed and the run, which would give the truth away: they are printed, and no more.
    """
    from ekfsim.files.logs.writing.written import format_of, write_log
    from ekfsim.provenance import told_in_a_line
    from ekfsim.simulation import simulate

    scene = scene_of(**chosen)
    for remark in write_log(scene, simulate(scene), out, force, with_truth, format):
        say(f"{out}: {remark}")
    told = _read_again(scene, format_of(scene, format), out)
    click.echo(f"{in_a_line(out)}: {in_a_line(told)}")
    if scene.commanded and not with_truth:
        click.echo(f"Only here it is told what made it: {told_in_a_line(scene)}")


def _read_again(scene: "Scene", format: str, out: Path) -> str:
    """What was written, and how it is read."""
    from shlex import quote

    if format != "log":
        return f"a {format} log; run the filter on it with --log"
    filter = f" --filter {scene.filter}" if scene.filter != "ekf" else ""
    gate = "off" if scene.gate is None else f"{scene.gate:.12g}"
    own = f"--log {quote(str(out))}{filter} --gate {gate}"
    return f"a log; run the filter on it with: ekfsim run log {own}"
