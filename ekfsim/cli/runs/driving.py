"""The command that drives a robot by keys: drive."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of_place
from ekfsim.cli.program.kinds import Result, Word
from ekfsim.cli.program.options import EXPLAIN, drive_options
from ekfsim.views.terminal.driving.help import HELP

if TYPE_CHECKING:
    from ekfsim.scene import Scene

PICTURES = Path("out")  # the folder for those of the key s, as in play


@click.command(
    help="Drive the robot through WORLD by keys, and write what was done as a commands file.\n\n"
    f"\b\n{HELP}",
    short_help="Drive the robot through WORLD by keys, into a commands file.",
)
@drive_options
@click.option(
    "--out",
    "-o",
    type=Result(),
    default=Path("drive.yaml"),
    show_default=True,
    help="The commands file that w writes; where another lies there, a number is put behind "
    "the name.",
)
@click.option("--force", is_flag=True, help="Replace the file that lies there.")
@click.option(
    "--show",
    type=Word(["auto", "window", "image", "text", "files"]),
    default="auto",
    show_default=True,
    help="Draw in a window, as an image in a terminal that has them, as text in any, or into one "
    "file rewritten in place: see play.",
)
@click.option(
    "--conditional",
    is_flag=True,
    help="Draw the ellipse for the heading at either edge of its cone, too.",
)
@EXPLAIN
def drive(
    place: str, out: Path, force: bool, show: str, conditional: bool, explain: bool,
    confidence: float, **chosen: Any,
) -> None:  # fmt: skip
    """A commands file is driven on from where it ends."""
    from ekfsim.views.driving.course import Course
    from ekfsim.views.driving.saving import Saving
    from ekfsim.views.picture.look import Look
    from ekfsim.views.terminal.interactive import drive_interactively

    saving = Saving(out, force)
    course = Course(_scene_to_drive(place, out, **chosen))
    drive_interactively(course, saving, show, PICTURES, Look(confidence, conditional), explain)


def _scene_to_drive(place: str, out: Path, world: str | None, **chosen: Any) -> "Scene":
    """The scene that is driven on from. Raises UsageError where it was recorded."""
    from ekfsim.files.packaged import packaged, resolve
    from ekfsim.files.source import as_written
    from ekfsim.files.yaml.parsing import parse
    from ekfsim.views.driving.course import RECORDED, refusal

    path = resolve(place, "commands" if place in packaged("commands") else "worlds")
    root, _ = parse(as_written(path, str(path)), str(path))
    if root.at(("recording",)) is not None:  # even where it names no log
        raise refusal(place, RECORDED)
    return scene_of_place(place, out, world, **chosen)
