"""The command line: each command an outline of what it does. Heavy modules are imported where they are used."""

import math
import os
import re
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

INTERRUPTED = 130
MOST = 2**63 - 1
CONTROLS = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\udc80-\udcff]")  # and bytes of a file's name that are no text
FORCE = click.option("--force", is_flag=True, help="Replace results that exist already.")


def main() -> NoReturn:
    """Run the program and exit with its status: 0 done, 1 the run failed, 2 wrong usage or file, 130, 143."""
    _open_closed_streams()
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)  # Windows does not hang up
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)
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
        with suppress(OSError):
            mistake.show()
        return mistake.exit_code
    except EkfsimError as error:
        _say(str(error))
        return error.status
    except (KeyboardInterrupt, click.Abort):
        _say("interrupted")
        return INTERRUPTED
    except (_UnreadError, BrokenPipeError):
        _forget_what_is_buffered()
        return 0
    except OSError as refusal:
        if refusal.filename is not None:
            raise  # no write to standard output, but a mistake of ours
        _forget_what_is_buffered()
        _say(f"writing to standard output failed: {refusal.strerror}")
        return 1


def _open_closed_streams() -> None:
    """Give a stream that was closed by whoever started us (`>&-`) to /dev/null: no result must come in its place."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115 (open to the end)


def _forget_what_is_buffered() -> None:
    """What could not be written to standard output must not fail once more at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _end(number: int, frame: FrameType | None) -> NoReturn:
    """End by an exception, so that every block cleans up behind itself, undisturbed by whoever is impatient."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    sys.exit(128 + number)


def _say(text: str) -> None:
    with suppress(OSError):
        lines = (line if _placed(line) else f"ekfsim: {line}" for line in _shown(text).split("\n"))
        click.echo("\n".join(lines), err=True)


def _shown(text: object) -> str:
    r"""A text, in which the name of a file may stand, as it does no harm to a terminal.

    >>> print(_shown("red\x1b[31m.yaml"))
    red\x1b[31m.yaml
    """
    return CONTROLS.sub(lambda found: f"\\x{ord(found[0]) & 0xFF:02x}", str(text))


def _placed(line: str) -> bool:
    """Whether a line begins with file:line:col, which an editor wants to find at its very start."""
    return line.count(":") > 2 and line.split(":")[1].isdigit() and line.split(":")[2].isdigit()


class _UnreadError(Exception):
    """Whoever read our output has seen enough."""


class Program(click.Group):
    """The commands. click itself would make a failure of a closed pipe."""

    def make_context(
        self, info_name: str | None, args: list[str], parent: click.Context | None = None, **extra: Any
    ) -> click.Context:
        """Parse the arguments, and print the help that they ask for."""
        try:
            return super().make_context(info_name, args, parent, **extra)
        except BrokenPipeError:
            raise _UnreadError from None

    def invoke(self, ctx: click.Context) -> Any:
        """Do what the arguments ask for."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise _UnreadError from None


class Probability(click.FloatRange):
    """A number between 0 and 1, and neither of them."""

    def __init__(self) -> None:
        super().__init__(0, 1, min_open=True, max_open=True)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """A float. Fails for nan too, which lies in no range and outside of none."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail(f"{value} is not in the range {self._describe_range()}.", param, ctx)
        return number


class Result(click.Path):
    """Where a result is to be written."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """A path. Fails for a name that an unset variable leaves, and for the dash that other programs know."""
        if value == "":
            self.fail("the name is empty.", param, ctx)
        if value == "-":
            self.fail("'-' names no file; /dev/stdout is the standard output.", param, ctx)
        return super().convert(value, param, ctx)


def scene_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options by which every command that plays a scene may overrule its file."""
    options = [
        click.argument("commands"),
        click.option("--world", help="A world file or packaged world in place of the one that COMMANDS names."),
        click.option("--seed", type=click.IntRange(min=0), help="In place of the file's seed."),
        click.option("--run", "run_number", type=click.IntRange(0, MOST), default=0, help="Which run of the seed."),
        click.option("--filter", "filter_name", help="ekf."),
        click.option("--gate", type=Probability(), metavar="P",
                     help="Refuse readings whose NIS lies beyond this χ² quantile."),
        click.option("--guard", type=click.Choice(["off", "warn", "skip"]), help="What to do about ambiguous beams."),
        click.option("--confidence", type=Probability(), default=0.954,
                     show_default=True, help="Probability of the ellipse and the cone."),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


@click.group(cls=Program, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="ekfsim", message="%(prog)s %(version)s")
def ekfsim() -> None:
    """Simulate a robot that localizes itself with an extended Kalman filter, and read every calculation.

    COMMANDS is a commands file, or the name of one that comes along: try `ekfsim play tour` and press n.
    """


@ekfsim.command()
@scene_options
@click.option("--show", type=click.Choice(["auto", "window", "text", "files"]), default="auto", show_default=True,
              help="Draw in a window, as text in the terminal, or into one file rewritten in place.")  # fmt: skip
@click.option("--out", "-o", type=Result(), default=Path("out"), show_default=True,
              help="Folder for the pictures of --show files and of the key s.")  # fmt: skip
@click.option("--conditional", is_flag=True, help="Draw the ellipse for the heading at either edge of its cone, too.")
@FORCE
def play(show: str, out: Path, conditional: bool, force: bool, confidence: float, **chosen: Any) -> None:
    """Step through COMMANDS with single keys: n next, p back, q quit, ? for all of them."""
    from ekfsim.views.interactive import play_interactively
    from ekfsim.views.look import Look

    play_interactively(_scene(**chosen), show, out, Look(confidence, conditional), force)


@ekfsim.command()
@scene_options
@click.option("--out", "-o", type=Result(), required=True,
              help="A folder for numbered PNG files, or the name of a .gif or an .mp4.")  # fmt: skip
@click.option("--every", type=click.IntRange(min=1), default=1, metavar="N", help="Only every N-th picture.")
@click.option("--conditional", is_flag=True, help="Draw the ellipse for the heading at either edge of its cone, too.")
@FORCE
def render(out: Path, every: int, conditional: bool, force: bool, confidence: float, **chosen: Any) -> None:
    """Draw every step of COMMANDS into files."""
    from ekfsim.localization import play as steps_of
    from ekfsim.views import animation, limits
    from ekfsim.views.look import Look
    from ekfsim.views.playback import number_of_views, views

    scene = _scene(**chosen)
    extent = limits.of(scene, steps_of(scene), confidence)
    pictures = animation.number_of_pictures(number_of_views(scene.commands), every)
    with click.progressbar(length=pictures, label="pictures", file=sys.stderr, hidden=not sys.stderr.isatty()) as bar:
        animation.render(
            views(steps_of(scene)), scene, extent, out, look=Look(confidence, conditional), every=every, force=force,
            progress=lambda made: bar.update(1),
        )  # fmt: skip
    click.echo(f"{_shown(out)}: {pictures} {'picture' if pictures == 1 else 'pictures'}")


@ekfsim.command()
@scene_options
@click.option("--trace", type=Result(), help="Write every number of every step, as JSON lines.")
@click.option("--tum", type=Result(), help="Folder for truth.tum and estimate.tum.")
@click.option("--csv", type=Result(), help="Write a flat table.")
@click.option("--summary", type=Result(), help="Write the closing summary as JSON.")
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
        try:
            found = mistakes_in(Path(file))
        except UsageError as missing:
            _say(str(missing))
            wrong = True
            continue
        for warning in found.warnings:
            _say(warning)
        click.echo(_shown("\n".join(map(str, found.mistakes)) or f"{file}: ok"))
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
@click.argument("file", type=Result())
@click.option("--kind", type=click.Choice(["world", "commands"]), help="Where the name of FILE does not tell.")
@FORCE
def new(file: Path, kind: str | None, force: bool) -> None:
    """Write a commented world or commands FILE to start from."""
    from ekfsim.files.template import template
    from ekfsim.files.writing import whole_text

    name = file.stem.lower()
    if kind is None and ("world" in name) == ("command" in name):
        raise UsageError(f"{file}: a world or commands? say --kind world or --kind commands")
    told: Literal["world", "commands"] = (
        "world" if kind == "world" or (kind is None and "world" in name) else "commands"
    )
    with whole_text(file, force) as out:
        out.write(template(told))
    click.echo(_shown(f"{file}: a {told} file to start from; ekfsim check {file} validates it"))


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
    for name in ("world_source", "commands_source"):  # every output holds them, in a line
        chosen[name] = _shown(getattr(scene, name)).replace("\n", "\\x0a")
    return replace(scene, **{name: value for name, value in chosen.items() if value is not None})
