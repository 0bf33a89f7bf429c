"""The command that steps through a run with single keys: play."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import files_of, scene_of
from ekfsim.cli.program.kinds import Pace, Result, Word
from ekfsim.cli.program.options import EXPLAIN, FORCE, scene_options
from ekfsim.views.terminal.keys.help import HELP

if TYPE_CHECKING:
    pass


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
