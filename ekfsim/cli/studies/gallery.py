"""The command that shows all scenarios side by side: gallery."""

from pathlib import Path

import click

from ekfsim.cli.program.asked import engine_of
from ekfsim.cli.program.kinds import Result, Whole
from ekfsim.cli.program.options import FORCE
from ekfsim.cli.program.process import part_with, shown
from ekfsim.cli.program.progress import blocks_bar
from ekfsim.printable import in_a_line


@click.command(short_help="Make a web site of all scenarios that come along.")
@click.option(
    "--out",
    "-o",
    type=Result(),
    required=True,
    help="A folder for index.html, and a picture and a page of each scenario.",
)
@click.option("--only", metavar="NAME,…", help="These scenarios in place of all.")
@click.option(
    "--markdown",
    "in_markdown",
    is_flag=True,
    help="Print one page of Markdown, and put the pictures alone into the folder.",
)
@click.option(
    "--cures",
    type=Whole(0, 1_000_000),
    default=200,
    show_default=True,
    metavar="N",
    help="Runs of each scenario under each cure, 20 of a drive at most; 0: no table of them.",
)
@click.option(
    "--workers",
    type=Whole(1, 1024),
    default=1,
    show_default=True,
    metavar="N",
    help="Processes on this machine.",
)
@FORCE
def gallery(
    out: Path, only: str | None, in_markdown: bool, cures: int, workers: int, force: bool
) -> None:
    """Make a web site of all scenarios that come along: of each a page that plays its run in a
    browser, a picture of how it ends, the verdict on it, what many runs find, and how many of
    them are lost under each cure.

    It opens as a file, and loads nothing from elsewhere. Recorded logs are left out.
    """
    part_with()
    from ekfsim.views.picture.look import get_ready

    get_ready()
    from ekfsim.views.gallery.making import chosen, write_gallery
    from ekfsim.views.gallery.markdown import markdown
    from ekfsim.views.gallery.site import INDEX

    names = chosen([name.strip() for name in only.split(",")] if only is not None else [])
    engine = engine_of(workers, None)
    with blocks_bar(len(names), "scenarios") as done:
        wings = write_gallery(names, out, engine, not in_markdown, force, cures, done)
    if in_markdown:
        click.echo(shown(markdown(wings, out)), nl=False)
    else:
        number = "1 scenario" if len(names) == 1 else f"{len(names)} scenarios"
        click.echo(in_a_line(f"{out}: {number}; open {out / INDEX}"))
