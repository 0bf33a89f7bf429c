"""What happened, marked in the panels: events, readings that were not used, where it was lost."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ekfsim.geometry import Integers
from ekfsim.views.curves.events import Happened
from ekfsim.views.curves.judged import lifted
from ekfsim.views.curves.pens import pen
from ekfsim.views.curves.series import Series
from ekfsim.views.picture.artists import PURPLE, VERMILLION
from ekfsim.views.picture.written.lettering import drawable, families

BASE = 0.03  # of an Axes' height: where a reading is marked that has no NIS
SAID = "#777777"
LATE = 0.6  # of the run: from there on words stand to the left of their line


class Mark(NamedTuple):
    """How a kind of event is drawn."""

    marker: str
    colour: str | None  # None: that of the filter whom it befell
    dashes: tuple[float, tuple[float, ...]] | None = (
        None  # of the line through all panels, where it has one
    )
    size: float = 7.0


MARKS = {
    Happened.KIDNAP: Mark("*", VERMILLION, (0, (5, 3)), 11),
    Happened.BUMP: Mark("P", PURPLE, (0, (3, 1, 1, 1))),
    Happened.SAY: Mark("|", SAID, size=9),
    Happened.AMBIGUOUS: Mark("^", None, size=8),
    Happened.GUARD: Mark("D", None),
    Happened.GATE: Mark("X", None, size=8),
    Happened.NO_WALL: Mark("s", None),
    Happened.NO_ECHO: Mark("v", None),
}


def mark_moments(panels: Sequence[Axes], run: Series) -> None:
    """Mark what befell the robot, whoever watches: over the first panel, with lines through all."""
    for happened, mark in MARKS.items():
        x = run.abscissa[_rows(run, happened)]
        if mark.colour is None or not len(x):
            continue
        top = panels[0]
        top.plot(
            x, np.ones(len(x)), marker=mark.marker, ms=mark.size, color=mark.colour, ls="",
            transform=top.get_xaxis_transform(), clip_on=False, zorder=5,
            gid=f"event-{happened.name.lower()}",
        )  # fmt: skip
        if mark.dashes is not None:
            for axes in panels:
                axes.vlines(
                    x, 0, 1, colors=mark.colour, linestyles=mark.dashes, linewidths=0.9,
                    transform=axes.get_xaxis_transform(), zorder=1.5,
                    gid=f"line-{happened.name.lower()}",
                )  # fmt: skip


def mark_readings(axes: Axes, runs: Sequence[Series]) -> None:
    """Mark in the panel of NIS what was ambiguous, and what was not used and why: at its NIS, at
    the foot where it has none.
    """
    for happened, mark in MARKS.items():
        for number, run in enumerate(runs if mark.colour is None else ()):
            rows = _rows(run, happened)
            nis = run.nis[rows]
            for known, told in ((~np.isnan(nis), "read"), (np.isnan(nis), "unread")):
                if not known.any():
                    continue
                high = told == "read"
                axes.plot(
                    run.abscissa[rows][known],
                    lifted(axes, nis[known]) if high else np.full(known.sum(), BASE),
                    marker=mark.marker, ms=mark.size, ls="", mfc="none", mew=1.1,
                    color=pen(number).colour, clip_on=False, zorder=3,
                    transform=axes.transData if high else axes.get_xaxis_transform(),
                    gid=f"{told}-{happened.name.lower()}-{number}",
                )  # fmt: skip


def mark_impossible(axes: Axes, runs: Sequence[Series]) -> None:
    """Mark at the head of the panel of NEES where a belief is impossible, and NEES undefined."""
    for number, run in enumerate(runs):
        x = run.abscissa[run.impossible]
        if len(x):
            axes.plot(
                x, np.full(len(x), 1 - BASE), marker="x", ms=6, mew=1.4, ls="",
                color=pen(number).colour, transform=axes.get_xaxis_transform(),
                gid=f"impossible-{number}",
            )  # fmt: skip


def mark_lost(panels: Sequence[Axes], runs: Sequence[Series]) -> None:
    """A line through all panels where each filter was lost for good; a tint from there on where
    there is one filter.
    """
    for number, run in enumerate(runs):
        if run.lost_from is None:
            continue
        x, colour = _lost_at(run), pen(number).colour
        for axes in panels:
            axes.axvline(x, color=colour, lw=1.6, ls=(0, (5, 2)), zorder=2, gid=f"lost-{number}")
            if len(runs) == 1:
                end = float(run.abscissa[-1])
                axes.axvspan(x, end, color=VERMILLION, alpha=0.07, lw=0, zorder=0, gid="lost-span")


def tell_lost(top: Axes, runs: Sequence[Series]) -> None:
    """Say it over the line; of filters that are lost at different steps one above the other."""
    steps: dict[int, list[int]] = {}
    for number, run in enumerate(runs):
        if run.lost_from is not None:
            steps.setdefault(run.lost_from, []).append(number)
    for lines, (step, numbers) in enumerate(steps.items()):
        x = _lost_at(runs[numbers[0]])
        names = f"{', '.join(runs[n].name for n in numbers)}: " if len(runs) > 1 else ""
        at = f" (t = {x:.6g} s)" if runs[0].clocked else ""
        right = x > LATE * runs[0].abscissa[-1]
        top.annotate(
            drawable(f"{names}lost since step {step}{at}"), (x, 1),
            (-6 if right else 6, 5 + 12 * lines), xycoords=top.get_xaxis_transform(),
            textcoords="offset points", ha="right" if right else "left", fontsize=9,
            color=pen(numbers[0]).colour if len(numbers) == 1 else "black", fontweight="bold",
            family=families(), parse_math=False, gid=f"lost-words-{step}",
        )  # fmt: skip


def _lost_at(run: Series) -> float:
    """Where on the axis that is."""
    return float(run.abscissa[np.searchsorted(run.index, run.lost_from or 0)])


def occurring(runs: Sequence[Series]) -> Iterator[tuple[Line2D, str]]:
    """The marks that a legend is to explain: of what occurs, and of nothing else."""
    for happened, mark in MARKS.items():
        if any(event.happened is happened for run in runs for event in run.events):
            colour = mark.colour or (pen(0).colour if len(runs) == 1 else "black")
            filled = colour if mark.colour else "none"
            yield (
                Line2D(
                    [], [], marker=mark.marker, ms=mark.size, color=colour, mfc=filled,
                    ls=mark.dashes or "", lw=0.9,
                ),
                happened.value,
            )  # fmt: skip
    if any(run.impossible.any() for run in runs):
        yield Line2D([], [], marker="x", mew=1.4, color="black", ls=""), "belief impossible"


def _rows(run: Series, happened: Happened) -> Integers:
    return np.array([e.row for e in run.events if e.happened is happened], np.int64)
