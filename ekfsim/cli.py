"""The command line: each command an outline of what it does. Heavy modules are imported where they are used."""

import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, Literal, NoReturn

import click

from ekfsim.errors import EkfsimError, UsageError

if TYPE_CHECKING:
    from ekfsim.scene import Scene

INTERRUPTED, TERMINATED = 130, 143
FORCE = click.option("--force", is_flag=True, help="Replace results that exist already.")


def main() -> NoReturn:
    """Run the program and exit with its status: 0 done, 1 the run failed, 2 wrong usage or file, 130, 143."""
    signal.signal(signal.SIGTERM, _terminate)
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, ValueError):
            stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    sys.exit(_status())


def _status() -> int:
    """What the program's exit status is; mistakes of its user end here in a sentence, ours keep their traceback."""
    try:
        ekfsim(standalone_mode=False)
        sys.stdout.flush()
        return 0
    except click.ClickException as mistake:
        mistake.show()
        return mistake.exit_code
    except EkfsimError as error:
        _say(str(error))
        return error.status
    except (KeyboardInterrupt, click.Abort):
        _say("interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        # whoever read our output has seen enough; what is still buffered must not fail at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as refusal:
        if refusal.filename is not None:
            raise  # no write to standard output, but a mistake of ours
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        _say(f"writing to standard output failed: {refusal.strerror}")
        return 1


def _terminate(signum: int, frame: FrameType | None) -> NoReturn:
    sys.exit(TERMINATED)  # as an exception, so that every block cleans up behind itself


def _say(text: str) -> None:
    with suppress(OSError):
        click.echo("\n".join(line if _placed(line) else f"ekfsim: {line}" for line in text.splitlines()), err=True)


def _placed(line: str) -> bool:
    """Whether a line begins with file:line:col, which an editor wants to find at its very start."""
    return line.count(":") > 2 and line.split(":")[1].isdigit() and line.split(":")[2].isdigit()


def scene_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options by which every command that plays a scene may overrule its file."""
    options = [
        click.argument("commands"),
        click.option("--world", help="A world file or packaged world in place of the one that COMMANDS names."),
        click.option("--seed", type=click.IntRange(min=0), help="In place of the file's seed."),
        click.option("--run", "run_number", type=click.IntRange(min=0), default=0, help="Which run of the seed."),
        click.option("--filter", "filter_name", help="ekf."),
        click.option("--gate", type=click.FloatRange(0, 1, min_open=True, max_open=True), metavar="P",
                     help="Refuse readings whose NIS lies beyond this χ² quantile."),
        click.option("--guard", type=click.Choice(["off", "warn", "skip"]), help="What to do about ambiguous beams."),
        click.option("--confidence", type=click.FloatRange(0, 1, min_open=True, max_open=True), default=0.954,
                     show_default=True, help="Probability of the ellipse and the cone."),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="ekfsim", message="%(prog)s %(version)s")
def ekfsim() -> None:
    """Simulate a robot that localizes itself with an extended Kalman filter, and read every calculation.

    COMMANDS is a commands file, or the name of one that comes along: try `ekfsim play tour` and press n.
    """


@ekfsim.command()
@scene_options
@click.option("--show", type=click.Choice(["auto", "window", "text", "files"]), default="auto", show_default=True,
              help="Draw in a window, as text in the terminal, or into one file rewritten in place.")  # fmt: skip
@click.option("--out", "-o", type=click.Path(path_type=Path), default=Path("out"), show_default=True,
              help="Folder for the pictures of --show files and of the key s.")  # fmt: skip
@click.option("--conditional", is_flag=True, help="Draw the ellipse for the heading at either edge of its cone, too.")
@FORCE
def play(show: str, out: Path, conditional: bool, force: bool, confidence: float, **chosen: Any) -> None:
    """Step through COMMANDS with single keys: n next, p back, q quit, ? for all of them."""
    from ekfsim.views.frames import Look
    from ekfsim.views.interactive import play_interactively

    play_interactively(_scene(**chosen), show, out, Look(confidence, conditional), force)


@ekfsim.command()
@scene_options
@click.option("--out", "-o", type=click.Path(path_type=Path), required=True,
              help="A folder for numbered PNG files, or the name of a .gif or an .mp4.")  # fmt: skip
@click.option("--every", type=click.IntRange(min=1), default=1, metavar="N", help="Only every N-th picture.")
@click.option("--conditional", is_flag=True, help="Draw the ellipse for the heading at either edge of its cone, too.")
@FORCE
def render(out: Path, every: int, conditional: bool, force: bool, confidence: float, **chosen: Any) -> None:
    """Draw every step of COMMANDS into files."""
    from ekfsim.localization import play as steps_of
    from ekfsim.views import animation, limits
    from ekfsim.views.frames import Look
    from ekfsim.views.playback import number_of_views, views

    scene = _scene(**chosen)
    extent = limits.of(scene, steps_of(scene), confidence)
    pictures = animation.number_of_pictures(number_of_views(scene.commands), every)
    with click.progressbar(length=pictures, label="pictures", file=sys.stderr, hidden=not sys.stderr.isatty()) as bar:
        animation.render(
            views(steps_of(scene)), scene, extent, out, look=Look(confidence, conditional), every=every, force=force,
            progress=lambda made: bar.update(1),
        )  # fmt: skip
    click.echo(f"{out}: {pictures} {'picture' if pictures == 1 else 'pictures'}")


@ekfsim.command()
@scene_options
@click.option("--trace", type=click.Path(path_type=Path), help="Write every number of every step, as JSON lines.")
@click.option("--tum", type=click.Path(path_type=Path), help="Folder for truth.tum and estimate.tum.")
@click.option("--csv", type=click.Path(path_type=Path), help="Write a flat table.")
@click.option("--summary", type=click.Path(path_type=Path), help="Write the closing summary as JSON.")
@click.option("--quiet", "-q", is_flag=True, help="Only the closing summary, no narrative.")
@FORCE
def run(
    trace: Path | None, tum: Path | None, csv: Path | None, summary: Path | None, quiet: bool, force: bool,
    confidence: float, **chosen: Any,
) -> None:  # fmt: skip
    """Narrate COMMANDS from the first step to the last, and sum up."""
    from ekfsim.files.outputs import Outputs
    from ekfsim.localization import play as steps_of
    from ekfsim.summary import Summary
    from ekfsim.views.closing import conclude
    from ekfsim.views.narrative import narrate
    from ekfsim.views.playback import views

    scene, result = _scene(**chosen), Summary()
    with Outputs(trace, tum, csv, summary, force).open(scene, confidence, result) as sinks:
        for view in views(steps_of(scene)):
            if not quiet:
                sys.stdout.write(narrate(view, scene, confidence))
            if not view.beam:
                result.add(view.step)
                for sink in sinks:
                    sink.write(view.step)
    sys.stdout.write(conclude(result))


@ekfsim.command()
@click.argument("files", nargs=-1, required=True)
def check(files: tuple[str, ...]) -> None:
    """Validate world and command FILES: every mistake with its place, or `ok`."""
    from ekfsim.files.load import check as mistakes_in

    wrong = False
    for file in files:
        found = mistakes_in(Path(file))
        for warning in found.warnings:
            click.echo(warning, err=True)
        click.echo("\n".join(map(str, found.mistakes)) or f"{file}: ok")
        wrong = wrong or bool(found.mistakes)
    if wrong:
        sys.exit(UsageError.status)


@ekfsim.command()
@click.argument("kind", type=click.Choice(["world", "commands"]))
def schema(kind: str) -> None:
    """Print the JSON Schema from which editors complete and check a world or commands file."""
    import json

    from ekfsim.files.schema import json_schema

    click.echo(json.dumps(json_schema(kind), indent=2, ensure_ascii=False))


@ekfsim.command("list")
def list_packaged() -> None:
    """List the worlds and commands that come along."""
    from ekfsim.files.packaged import description_of, packaged

    for kind in ("worlds", "commands"):
        click.echo(f"{kind}:")
        files = packaged(kind)
        for name, path in files.items():
            click.echo(f"  {name:{max(map(len, files))}}  {description_of(path)}")


@ekfsim.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--kind", type=click.Choice(["world", "commands"]), help="Where the name of FILE does not tell.")
@FORCE
def new(file: Path, kind: str | None, force: bool) -> None:
    """Write a commented world or commands FILE to start from."""
    from ekfsim.files.template import template
    from ekfsim.files.writing import whole_text

    name = file.stem.lower()
    if kind is None and ("world" in name) == ("command" in name):
        raise UsageError(f"{file}: a world or commands? say --kind world or --kind commands")
    told: Literal["world", "commands"] = "world" if kind == "world" or (kind is None and "world" in name) else "commands"
    with whole_text(file, force) as out:
        out.write(template(told))
    click.echo(f"{file}: a {told} file to start from; ekfsim check {file} validates it")


def _scene(
    commands: str, world: str | None, seed: int | None, run_number: int, filter_name: str | None,
    gate: float | None, guard: str | None,
) -> "Scene":  # fmt: skip
    """The scene of a commands file, overruled by the options that were given."""
    from dataclasses import replace

    from ekfsim.files.load import read_scene
    from ekfsim.files.packaged import resolve
    from ekfsim.filters import FILTERS

    if filter_name is not None and filter_name not in FILTERS:
        raise UsageError(f"--filter {filter_name}: there is no such filter; known: {', '.join(FILTERS)}")
    found = read_scene(resolve(commands, "commands"), None if world is None else resolve(world, "worlds"))
    for warning in found.warnings:
        _say(warning)
    scene = found.get()
    chosen: dict[str, Any] = {"seed": seed, "run": run_number, "filter": filter_name, "gate": gate, "guard": guard}
    return replace(scene, **{name: value for name, value in chosen.items() if value is not None})
