"""The options that several commands share, and what they accept."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

MOST = 2**63 - 1
READINGS = ("printed", "coded", "corrected")  # of a document; told here again, so that --help need not load them
READING = click.option("--reading", type=click.Choice(READINGS), default="corrected", show_default=True,
                       help="Which to follow where a document's print, its code and the truth differ.")  # fmt: skip
FORCE = click.option("--force", is_flag=True, help="Replace results that exist already.")


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
        click.option("--log", metavar="PATH", help="A recorded log in place of the one that COMMANDS names."),
        READING,
        click.option("--filter", "filter_name", help="In place of the file's filter: kf, ekf, iekf, ukf or pf."),
        click.option("--gate", type=Probability(), metavar="P",
                     help="Refuse readings whose NIS lies beyond this χ² quantile."),
        click.option("--guard", type=click.Choice(["off", "warn", "skip"]), help="What to do about ambiguous beams."),
        click.option("--confidence", type=Probability(), default=0.954,
                     show_default=True, help="Probability of the ellipse and the cone."),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command
