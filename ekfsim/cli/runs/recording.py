"""The command that writes a run as a log: record."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Result, Word
from ekfsim.cli.program.options import FORCE, scene_options
from ekfsim.cli.program.process import say
from ekfsim.printable import in_a_line

if TYPE_CHECKING:
    from ekfsim.scene import Scene


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
