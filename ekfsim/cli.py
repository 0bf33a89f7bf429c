"""The command line: each command an outline of what it does. Heavy modules are imported where they
are used.
"""

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NoReturn

import click

from ekfsim import process
from ekfsim.asked import engine_of, scene_of
from ekfsim.errors import MOST_TOLD, Mistake, RunError, UsageError, told
from ekfsim.options import (
    DOCUMENTS,
    EXPLAIN,
    FORCE,
    PLAIN,
    READING,
    Result,
    Seed,
    Source,
    Whole,
    Word,
    compare_options,
    scene_options,
    study_options,
)
from ekfsim.printable import in_a_line
from ekfsim.process import Program, heed, part_with, say, shown, warn, width
from ekfsim.progress import blocks_bar, study_into
from ekfsim.version import VERSION

if TYPE_CHECKING:
    from ekfsim.files.packaged import Folder


def main() -> NoReturn:
    """The program `ekfsim`."""
    process.run(ekfsim)


@click.group(
    cls=Program, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100}
)
@click.version_option(VERSION, message="%(prog)s %(version)s")
def ekfsim() -> None:
    """Simulate a robot that localizes itself with an extended Kalman filter, and read every
    calculation.

    COMMANDS is a commands file, or the name of one that comes along: try `ekfsim play tour` and
    press n.
    """


@ekfsim.command(short_help="Step through COMMANDS with single keys.")
@scene_options
@click.option("--show", type=click.Choice(["auto", "window", "text", "files"]), default="auto",
    show_default=True,
              help="Draw in a window, as text in the terminal, or into one file rewritten in "
                   "place.")  # fmt: skip
@click.option("--out", "-o", type=Result(), default=Path("out"), show_default=True,
              help="Folder for the pictures of --show files and of the key s.")  # fmt: skip
@click.option(
    "--conditional",
    is_flag=True,
    help="Draw the ellipse for the heading at either edge of its cone, too.",
)
@EXPLAIN
@FORCE
def play(
    show: str, out: Path, conditional: bool, explain: bool, force: bool, confidence: float,
    **chosen: Any
) -> None:  # fmt: skip
    """Step through COMMANDS with single keys: n next, p back, q quit, ? for all of them."""
    from ekfsim.views.picture.look import Look
    from ekfsim.views.terminal.interactive import play_interactively

    play_interactively(scene_of(**chosen), show, out, Look(confidence, conditional), force, explain)


@ekfsim.command()
@scene_options
@click.option(
    "--out",
    "-o",
    type=Result(),
    required=True,
    help="A folder for numbered PNG files, or the name of a .gif or an .mp4.",
)
@click.option("--every", type=Whole(min=1), default=1, metavar="N", help="Only every N-th picture.")
@click.option(
    "--conditional",
    is_flag=True,
    help="Draw the ellipse for the heading at either edge of its cone, too.",
)
@FORCE
def render(
    out: Path, every: int, conditional: bool, force: bool, confidence: float, **chosen: Any
) -> None:
    """Draw every step of COMMANDS into files."""
    from ekfsim.views.picture.look import Look, get_ready

    get_ready()
    from ekfsim.files.results.outputs import kept
    from ekfsim.localization import play as steps_of
    from ekfsim.views.film import animation
    from ekfsim.views.picture import limits
    from ekfsim.views.picture.lettering import boxes
    from ekfsim.views.terminal.playback import Tally, together
    from ekfsim.views.words.captions import texts

    scene, tally = scene_of(**chosen), Tally()
    warn(boxes(texts(scene)))
    first, *others = scene.alone()
    runs = (kept(steps_of(first), [tally.write]), *map(steps_of, others))
    extent = limits.of_all(scene, runs, confidence)
    pictures = animation.number_of_pictures(tally.views, every)
    with click.progressbar(
        length=pictures, label="pictures", file=sys.stderr, hidden=not sys.stderr.isatty()
    ) as bar:

        def made_one(made: int) -> None:
            heed()
            bar.update(1)

        animation.render(
            together(steps_of(first), map(steps_of, others)), scene, extent, out,
            look=Look(confidence, conditional), every=every, force=force, progress=made_one,
        )  # fmt: skip
    click.echo(f"{in_a_line(out)}: {pictures} {'picture' if pictures == 1 else 'pictures'}")


@ekfsim.command()
@scene_options
@click.option("--trace", type=Result(), help="Write every number of every step, as JSON lines.")
@click.option("--tum", type=Result(), help="Folder for truth.tum and estimate.tum.")
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
    from ekfsim.diagnostics.summary import Summary
    from ekfsim.files.results.outputs import Outputs, kept
    from ekfsim.localization import play as steps_of
    from ekfsim.views.terminal.playback import together
    from ekfsim.views.words.closing import conclude_all
    from ekfsim.views.words.narrative import narrate

    scene = scene_of(**chosen)
    alone, outputs = scene.alone(), Outputs(trace, tum, csv, summary, force)
    results = [Summary.of(one) for one in alone]
    with ExitStack() as stack:
        runs = []
        for one, result, files in zip(alone, results, outputs.for_each(scene), strict=True):
            sinks = stack.enter_context(files.open(one, confidence, result))
            runs.append(kept(result.following(steps_of(one)), [sink.write for sink in sinks]))
        for view in together(runs[0], runs[1:]):
            heed()
            if not quiet:
                sys.stdout.write(narrate(view, scene, confidence, explain))
    (sys.stderr if outputs.on_stdout() else sys.stdout).write(conclude_all(scene, results, quiet))


@ekfsim.command(short_help="Write the simulated run of COMMANDS as a recorded log.")
@scene_options
@click.option(
    "--out", "-o", type=Result(), required=True, help="A folder for the files of the log."
)
@FORCE
def record(out: Path, force: bool, confidence: float, **chosen: Any) -> None:
    """Write the simulated run of COMMANDS, a drive, as the files of a recorded log."""
    from ekfsim.files.logs import write_log
    from ekfsim.simulation import simulate

    scene = scene_of(**chosen)
    for remark in write_log(scene, simulate(scene), out, force):
        say(f"{out}: {remark}")
    click.echo(f"{in_a_line(out)}: a {scene.world.system} log; run the filter on it with --log")


@ekfsim.command(short_help="Validate FILES: every mistake with its place, or ok.")
@click.argument("files", nargs=-1, required=True)
def check(files: tuple[str, ...]) -> None:
    """Validate world and command FILES: every mistake with its place, or `ok`."""
    from ekfsim.files.packaged import packaged, resolve
    from ekfsim.files.scenes.check_study import check as mistakes_in

    # of a world that other files name, too, told once
    wrong, before, warned = False, set[Mistake](), set[str]()
    for file in files:
        try:
            found = mistakes_in(
                resolve(file, "worlds" if file in packaged("worlds") else "commands")
            )
        except UsageError as missing:
            say(str(missing))
            wrong = True
            continue
        new = [
            mistake
            for mistake in found.mistakes
            if not before or mistake.placed_alike not in before
        ]
        odd = (warning for warning in found.warnings if warning not in warned)
        warn(odd, MOST_TOLD - len(told(new)))  # together no more than anybody reads
        warned.update(found.warnings)
        if len(files) > 1:
            before.update(mistake.placed_alike for mistake in new)
        all_told = in_a_line(
            f"{file}: {'what is wrong with it is told above' if found.mistakes else 'ok'}"
        )
        click.echo("\n".join(told(new)) or all_told)
        wrong = wrong or bool(found.mistakes)
    if wrong:
        sys.exit(UsageError.status)


@ekfsim.command(short_help="Print the JSON Schema by which editors check a file.")
@click.argument("kind", type=click.Choice(["world", "commands", "study"]))
def schema(kind: str) -> None:
    """Print the JSON Schema from which editors complete and check a world, commands or study
    file.
    """
    import json
    from typing import cast

    from ekfsim.files.yaml.schema import Kind, json_schema

    click.echo(json.dumps(json_schema(cast("Kind", kind)), indent=2, ensure_ascii=False))


@ekfsim.command("list", short_help="List what comes along, or all that is said of NAME.")
@click.argument("name", required=False)
@click.option("--worlds", is_flag=True, help="The worlds in place of the commands.")
def list_packaged(name: str | None, worlds: bool) -> None:
    """List the commands that come along, or the worlds; with NAME, all that is said of that one."""
    from ekfsim.files.packaged import described, description_of, grouped, packaged, resolve

    if name is not None:
        is_world = worlds or (name in packaged("worlds") and name not in packaged("commands"))
        kind: Folder = "worlds" if is_world else "commands"
        click.echo(
            shown(described(resolve(name, kind)) or in_a_line(f"{name}: has no description"))
        )
        return
    for title, files in [("worlds", packaged("worlds"))] if worlds else grouped():
        click.echo(f"{title}:")
        for one, path in files.items():
            click.echo(f"  {one:{max(map(len, files))}}  {description_of(path)}")


@ekfsim.command()
@click.argument("file", type=Result())
@click.option(
    "--kind", type=click.Choice(["world", "commands"]), help="Where the name of FILE does not tell."
)
@FORCE
def new(file: Path, kind: str | None, force: bool) -> None:
    """Write a commented world or commands FILE to start from."""
    from ekfsim.files.results.writing import whole_text
    from ekfsim.files.template import template

    name = file.stem.lower()
    if kind is None and ("world" in name) == ("command" in name):
        raise UsageError(f"{file}: a world or commands? say --kind world or --kind commands")
    told: Literal["world", "commands"] = (
        "world" if kind == "world" or (kind is None and "world" in name) else "commands"
    )
    with whole_text(file, force) as out:
        out.write(template(told))
    click.echo(in_a_line(f"{file}: a {told} file to start from; ekfsim check {file} validates it"))


@ekfsim.command(epilog=DOCUMENTS, short_help="Draw the figures and tables of a document.")
@click.argument("name", type=Word(["classroom", "mower", "pioneer", "gnss", "pylon", "gallery"]))
@click.option(
    "--out",
    "-o",
    type=Result(),
    required=True,
    help="A folder for the figures, tables and captions.md.",
)
@click.option("--format", "formats", type=click.Choice(["png", "svg", "pdf"]), multiple=True,
    default=("png",),
              show_default=True, help="May be given several times.")  # fmt: skip
@click.option(
    "--log", type=Source(), metavar="PATH", help="A recorded log in place of the simulated twin."
)
@READING
@click.option("--seed", type=Seed(), help="In place of the scene's seed.")
@PLAIN
@FORCE
def figures(
    name: str,
    out: Path,
    formats: tuple[str, ...],
    log: str | None,
    reading: str,
    seed: int | None,
    force: bool,
) -> None:
    """Draw every figure and table of one of the five documents, or of the gallery, with
    captions.
    """
    from ekfsim.views.picture.look import get_ready

    get_ready()
    from ekfsim.figures import draw_figures

    simulated = {"classroom": "tour", "gallery": "diverge-00-control"}.get(name)
    commands = simulated or (name if log is None else f"{name}_log")
    scene = scene_of(commands, log=log, reading=reading, seed=seed)
    written = draw_figures(name, scene, out, formats, force)
    click.echo(in_a_line(f"{out}: {len(written)} files, read captions.md first"))


@ekfsim.command(short_help="Run COMMANDS many times: is the filter honest?")
@study_options
def study(
    out: Path | None,
    resume: bool,
    force: bool,
    workers: int,
    cluster: str | None,
    expect: bool,
    **asked: Any,
) -> None:
    """Run COMMANDS, or what a study file tells, many times: how often is it lost, and is the filter
    honest?
    """
    part_with()
    from ekfsim.files.scenes import load_study
    from ekfsim.files.scenes.filter_checks import refuse_unread
    from ekfsim.study.doing import unkept
    from ekfsim.study.engines import Paced
    from ekfsim.study.expectation import promised, verified
    from ekfsim.study.plan import Plan
    from ekfsim.views.study.promises import broken, verify
    from ekfsim.views.study.words import conclude

    if out is None and resume:
        raise click.MissingParameter(param_hint="'--out' / '-o'", param_type="option")
    plan = Plan.of(load_study.asked(**asked))
    refuse_unread(plan.settings, plan.filters)
    warn(plan.warnings)
    plan = promised(plan, asked["runs"]) if expect else plan
    engine = Paced(engine_of(workers, cluster))
    if out is None:
        with blocks_bar(plan.blocks * len(plan.cases)) as done:
            results = unkept(plan, engine, done)
    else:
        results = study_into(plan, engine, out, resume, force)
    if not expect:
        pace = engine.pace if plan.request.fast else 0.0
        click.echo(shown(conclude(plan, results, width(), pace)), nl=False)
        if out is None:
            say(
                "nothing of this is kept; -o FOLDER writes it with tables of every step, "
                "pictures, and what repeats it"
            )
        return
    found = verified(results[0])
    click.echo(shown(verify(plan, found)), nl=False)
    if told := broken(plan, found):
        raise RunError(told)


@ekfsim.command(short_help="Put two settings side by side, on the same draws.")
@compare_options
def compare(
    a: str | None,
    b: str | None,
    out: Path | None,
    force: bool,
    workers: int,
    cluster: str | None,
    **asked: Any,
) -> None:
    """Put two settings of COMMANDS side by side, each run under both on the same draws."""
    part_with()
    from ekfsim.files.results.writing import refuse_existing_folder
    from ekfsim.files.scenes import load_study
    from ekfsim.study.comparison import Comparison, with_sides
    from ekfsim.study.doing import total
    from ekfsim.views.study.compare_words import conclude

    comparison = Comparison.of(with_sides(load_study.asked(**asked, sweeps=()), a, b))
    warn(comparison.warnings)
    if out is not None:
        from ekfsim.views.picture.look import get_ready

        get_ready()
        from ekfsim.views.study.compare_folder import FILES, write_comparison

        refuse_existing_folder(out, *FILES, force=force)
    with blocks_bar(comparison.a.blocks) as done:
        found = total(comparison, comparison.tasks(), engine_of(workers, cluster), done)
    if out is not None:
        write_comparison(comparison, found, out, force)
    click.echo(shown(conclude(comparison, found, width())), nl=False)
