"""The options that several commands share, and what they accept."""

import re
from collections.abc import Callable, Sequence
from typing import Any

import click

from ekfsim.cli.program.kinds import Gate, Probability, Seed, Source, Whole, Word
from ekfsim.errors import UsageError
from ekfsim.twins import taking

MOST = 2**63 - 1  # of runs' numbers
MOST_RUNS = 10**9  # of a study
MOST_PARTICLES = 10**6  # of a run
MOST_HYPOTHESES = 64  # of a run
LEAST_SIDE, MOST_SIDE = 200, 10_000  # px, of a picture
# of a document; told here again, so that --help need not load them
READINGS = ("printed", "coded", "corrected")
READING = click.option(
    "--reading",
    type=Word(READINGS),
    default="corrected",
    show_default=True,
    help="Which to follow where a document's print, its code and the truth differ.",
)
SET = click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    help="Overrule a number of the world, e.g. noise.rangeSigmaRatio=0.02, "
    "or of the filter, e.g. filter.alpha=0.5; repeatable.",
)


def _one_way(ctx: click.Context, param: click.Parameter, value: bool) -> bool:
    """Whether a way to calculate was chosen. Fails where another was chosen, too."""
    if value and ctx.meta.setdefault(__name__, param.name) != param.name:
        raise UsageError("--plain and --fast are two ways to calculate; choose one")
    if value and param.name == "plain":
        ctx.with_resource(taking("plain"))
    return value


FAST = click.option(
    "--fast",
    is_flag=True,
    callback=_one_way,
    help="Calculate with code that Numba compiles (the extra `fast`): whole runs of ekf, huber and "
    "pdaf in the classroom, of all else beams and matrices.",
)
PLAIN = click.option(
    "--plain",
    is_flag=True,
    callback=_one_way,
    expose_value=False,
    help="Calculate as the readable code stands, without its quicker twins: "
    "slow, and alike but for the last digits.",
)
EXPLAIN = click.option(
    "--explain", is_flag=True, help="Narrate in the long form: every matrix, every equation."
)
FORCE = click.option("--force", is_flag=True, help="Replace results that exist already.")


def _pixels(
    ctx: click.Context, param: click.Parameter, value: str | None
) -> tuple[int, int] | None:
    """Width and height. Fails for what is no such pair, and beyond what a picture can be."""
    if value is None:
        return None
    found = re.fullmatch(r"([0-9]{1,9})[xX×]([0-9]{1,9})", value)
    if found is None:
        raise click.BadParameter(f"{value!r} is no size; write pixels like 1280x720.", ctx, param)
    width, height = map(int, found.groups())
    if not all(LEAST_SIDE <= side <= MOST_SIDE for side in (width, height)):
        raise click.BadParameter(
            f"{value} is no size of a picture; each side has {LEAST_SIDE} to {MOST_SIDE} pixels.",
            ctx,
            param,
        )
    return width, height


SIZE = click.option(
    "--size",
    callback=_pixels,
    metavar="WxH",
    help="How many pixels a picture has: 1280x720.",
)
DPI = click.option(
    "--dpi",
    type=Whole(30, 1200),
    default=100,
    show_default=True,
    help="Pixels to an inch: letters and lines grow with it, and the picture too without --size.",
)


PARTICLES = click.option(
    "--particles",
    type=Whole(1, MOST_PARTICLES),
    metavar="N",
    help="Of each run: of pf (1000), of amcl at most (5000); short for --set filter.particles=N.",
)
HYPOTHESES = click.option(
    "--hypotheses",
    type=Whole(1, MOST_HYPOTHESES),
    metavar="N",
    help="Gaussians that mhekf keeps at most; short for --set filter.hypotheses=N.",
)
GATE = click.option(
    "--gate",
    type=Gate(),
    metavar="P|off",
    help="Refuse readings whose NIS lies beyond this χ² quantile; off refuses none.",
)
DOCUMENTS = """\b
Documents, by the numbers under which captions cite them:
  000  mower      Kiriy, Buehler: Three-state Extended Kalman Filter for
                  Mobile Robot Localization, 2002
  001  pioneer    Tamás, Lazea, Robotin, Marcu, Herle, Szekely: State Estimation
                  Based on Kalman Filtering Techniques in Navigation
  002  classroom  Localization and the extended Kalman filter, an assignment
  003  gnss       Sahni: Assignment 3: Sensor fusion for lawn mower, 2023
  004  pylon      King, Johnson: Lab 3: Extended Kalman Filter for Localization
"""
GUARD = click.option(
    "--guard", type=Word(["off", "warn", "skip"]), help="What to do about ambiguous beams."
)


WORLD = click.option(
    "--world", help="A world file or packaged world in place of the one that COMMANDS names."
)
SEED = click.option("--seed", type=Seed(), help="In place of the file's seed.")
RUN = click.option(
    "--run", "run_number", type=Whole(0, MOST), default=0, help="Which run of the seed."
)
PLAYED = (  # which run of which file
    click.argument("commands"),
    WORLD,
    SEED,
    RUN,
    click.option(
        "--log",
        type=Source(),
        metavar="PATH",
        help="A recorded log in place of the one that COMMANDS names, or of its commands.",
    ),
    READING,
)
SETTINGS = (  # what overrules the files in every run of a study
    SET,
    PARTICLES,
    HYPOTHESES,
    GATE,
    GUARD,
    click.option(
        "--reading",
        type=Word(READINGS),
        help="Which to follow where a document's print, its code and the truth differ.",
    ),
)


SMOOTH = click.option(
    "--smooth",
    is_flag=True,
    help="Beside each filter, what it believes once the whole run is known (Rauch-Tung-Striebel); "
    "short for --filter ekf,ekf-smoothed.",
)
WATCHED = (  # by whom a run is watched
    click.option(
        "--filter",
        "filter_name",
        metavar="NAME,…",
        help="In place of the file's filter: "
        "kf, kf-nominal, ekf, iekf, ukf, ukf-augmented, huber, pdaf, adaptive, invariant, mhekf, "
        "pf or amcl, or one of your own, FILE.py, FILE.py:NAME or package.module:NAME. Several are "
        "put side by side; the name of each then stands before the ending of its files.",
    ),
    SMOOTH,
    GATE,
    GUARD,
    SET,
    PARTICLES,
    HYPOTHESES,
    click.option(
        "--confidence",
        type=Probability(),
        default=0.954,
        show_default=True,
        help="Probability of the ellipse and the cone.",
    ),
    PLAIN,
)


def scene_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options by which every command that plays a scene may overrule its file."""
    return with_options(command, [*PLAYED, *WATCHED])


def drive_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The same of the command that makes a commands file."""
    place = click.argument("place", metavar="WORLD|COMMANDS")
    return with_options(command, [place, WORLD, SEED, RUN, *WATCHED])


def with_options(
    command: Callable[..., Any], options: Sequence[Callable[..., Any]]
) -> Callable[..., Any]:
    """A command that has the options, told by --help in their order."""
    for option in reversed(options):
        command = option(command)
    return command
