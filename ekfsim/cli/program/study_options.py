"""The options of a study and of a comparison: which runs, watched by whom, made where."""

from collections.abc import Callable
from typing import Any

import click

from ekfsim.cli.program.kinds import Result, Source, Whole
from ekfsim.cli.program.options import (
    FAST,
    FORCE,
    MOST_RUNS,
    PLAIN,
    SEED,
    SETTINGS,
    SMOOTH,
    WORLD,
    with_options,
)

MADE_WHERE = (
    click.option(
        "--workers",
        type=Whole(1, 1024),
        default=1,
        show_default=True,
        metavar="N",
        help="Processes on this machine.",
    ),
    click.option(
        "--cluster",
        metavar="ADDRESS",
        help="The scheduler of a Dask cluster, e.g. tcp://10.0.0.1:8786.",
    ),
    FAST,
    PLAIN,
)


def study_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a study: which runs, watched by whom, made where."""
    return with_options(
        command,
        [
            click.argument("commands", metavar="COMMANDS|STUDY.yaml"),
            WORLD,
            click.option(
                "--runs",
                type=Whole(1, MOST_RUNS),
                metavar="N",
                help="How many runs of each cell and filter; 10000 where nothing says otherwise.",
            ),
            SEED,
            click.option(
                "--filter",
                "filters",
                metavar="NAME,…",
                help="Filters that watch the same runs, e.g. ekf,ukf or ekf,mine.py: see play.",
            ),
            SMOOTH,
            click.option(
                "--sweep",
                "sweeps",
                multiple=True,
                metavar="KEY=V1,V2,…",
                help="Values of a number of the world or the filter, of gate or of guard; "
                "several make a grid.",
            ),
            *SETTINGS,
            click.option(
                "--log",
                type=Source(),
                metavar="PATH",
                help="A recorded log, each cell played once: see play.",
            ),
            *MADE_WHERE,
            click.option("--resume", is_flag=True, help="Go on with a study that did not end."),
            click.option(
                "--expect",
                is_flag=True,
                help="Verify what COMMANDS promises under `expect`: status 1 where it is not kept.",
            ),
            click.option(
                "--out",
                "-o",
                type=Result(),
                help="A folder for tables and pictures; a first look needs none.",
            ),
            FORCE,
        ],
    )


def compare_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a comparison: which two settings, of which runs, made where."""
    return with_options(
        command,
        [
            click.argument("commands", metavar="COMMANDS|COMPARE.yaml"),
            click.option(
                "--a",
                "a",
                metavar="KEY=VALUE,…",
                help="What one side sets: numbers of the world, gate, guard, filter; "
                "nothing where left out.",
            ),
            click.option("--b", "b", metavar="KEY=VALUE,…", help="What the other side sets."),
            WORLD,
            click.option(
                "--runs",
                type=Whole(1, MOST_RUNS),
                metavar="N",
                help="How many runs; 10000 where nothing says otherwise.",
            ),
            SEED,
            click.option(
                "--filter",
                "filters",
                metavar="NAME",
                help="In place of the file's filter, on both sides: see play.",
            ),
            *SETTINGS,
            *MADE_WHERE,
            click.option(
                "--out",
                "-o",
                type=Result(),
                help="A folder for a table, a picture and what repeats them.",
            ),
            FORCE,
        ],
    )
