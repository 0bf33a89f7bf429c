"""The command that narrates a run: run."""

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Result
from ekfsim.cli.program.options import EXPLAIN, FORCE, scene_options
from ekfsim.cli.program.process import heed, say

if TYPE_CHECKING:
    pass


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
    from ekfsim.views.words.narrative.narrating import narrate

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
