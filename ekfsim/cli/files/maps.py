"""The command that makes a world of a plan that another program wrote."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.kinds import Result, Source, Word
from ekfsim.cli.program.options import FORCE
from ekfsim.cli.program.process import warn
from ekfsim.errors import UsageError
from ekfsim.printable import in_a_line

if TYPE_CHECKING:
    from ekfsim.files.maps.plan import Start


class Pose(click.ParamType):  # type: ignore[type-arg]  # takes one in newer clicks alone
    """Where a robot stands, and whereto it looks."""

    name = "pose"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> "Start":
        """x, y in m and θ in degrees. Fails for what is none."""
        import math

        try:
            x, y, theta = map(float, str(value).split(","))
        except ValueError:
            x = y = theta = math.nan
        if not all(map(math.isfinite, (x, y, theta))):
            self.fail(f"{value!r} is no pose; write X,Y,THETA in m, m and degrees, e.g. 1,2.5,90",
                      param, ctx)  # fmt: skip
        return x, y, theta


class Length(click.ParamType):  # type: ignore[type-arg]  # as above
    """A length, m."""

    name = "length"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """A number of metres, more than 0. Fails for anything else."""
        try:
            metres = float(value)
        except ValueError:
            metres = 0.0
        if not 0 < metres < 1e4:
            self.fail(f"{value!r} is no length; write metres, e.g. 0.1", param, ctx)
        return metres


@click.command(short_help="Make a world of a ROS map or a drawing.")
@click.argument("plan", metavar="FROM", type=Source())
@click.option("--out", "-o", type=Result(), required=True, help="The world file.")
@click.option("--start", type=Pose(), metavar="X,Y,THETA",
              help="Where the robot starts; where it has most room, if left out.")  # fmt: skip
@click.option("--tolerance", type=Length(), metavar="M",
              help="How far a wall may be drawn from where the plan has it, in m.")  # fmt: skip
@click.option("--unknown", type=Word(["wall", "free"]), default="wall", show_default=True,
              help="What the cells of a ROS map are that nobody has seen.")  # fmt: skip
@click.option("--units", type=Word(["degrees", "m", "cm", "mm", "in", "ft"]),
              help="What one of a drawing's coordinates is, where it does not say so.")  # fmt: skip
@click.option("--boundary", type=Word(["auto", "none"]), default="auto", show_default=True,
              help="Whether the outline about all else is the room, or an obstacle.")  # fmt: skip
@click.option("--outlines", type=Word(["solid", "walls"]), default="solid", show_default=True,
              help="Whether outlines are solid, or rooms with walls about them.")  # fmt: skip
@click.option("--picture", type=Result(), metavar="FILE",
              help="Plan and walls over each other, .png, .svg or .pdf; beside the world, if "
              "left out.")  # fmt: skip
@click.option("--name", help="Of the world; that of the file, if left out.")
@FORCE
def world(
    plan: str, out: Path, start: "Start | None", tolerance: float | None, unknown: Any, units: Any,
    boundary: Any, outlines: Any, picture: Path | None, name: str | None, force: bool,
) -> None:  # fmt: skip
    """Make a world file of a plan that another program wrote, and draw both over each other.

    FROM is a ROS map (its map.yaml, whose picture is read with it), a world of ir-sim, GeoJSON,
    WKT, DXF or SVG. Walls of pixels become straight within the tolerance; of a drawing, polygons
    become obstacles, lines walls, and points with an id landmarks. All that was assumed and left
    out is told, and stands in the head of the world file.
    """
    from ekfsim.files.maps.making import make
    from ekfsim.files.maps.plan import Asked
    from ekfsim.files.results.writing import refuse_existing, special, whole_text

    refuse_existing(out, force)
    drawn = picture or (None if special(out) else out.with_suffix(".png"))
    if drawn is not None:
        from ekfsim.views.film.still import refuse
        from ekfsim.views.picture.look import get_ready

        get_ready()
        refuse(drawn, force)
        if drawn.resolve() == out.resolve():
            raise UsageError(f"{out}: world and picture cannot be one file")
    made = make(Path(plan), plan, Asked(tolerance, unknown, start, units, boundary, outlines), name)
    warn(made.told)
    with whole_text(out, force) as file:
        file.write(made.text)
        if drawn is not None:
            from ekfsim.views.film.overlay import draw

            draw(made.plan, made.start, drawn, made.source, force)
    where = "" if drawn is None else f"; {in_a_line(drawn)} shows it over the plan"
    click.echo(in_a_line(f"{out}: {made.summary}{where}"))
