"""What is drawn of the lost and of the cured run on the map."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from ekfsim.commands import Move
from ekfsim.filters.belief import posed
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import outline
from ekfsim.records import Step
from ekfsim.views.picture.artists import (
    BLUE,
    ORANGE,
    TRUTH,
    VERMILLION,
    Dashes,
    direction,
    robot,
)
from ekfsim.views.why.met import Met

MOST_ELLIPSES = 8  # of each run
BODY = 0.012  # of the picture's longer side: the radius of a robot


@dataclass(frozen=True, slots=True)
class Trace:
    """How one of the two runs is drawn."""

    name: str  # also of its artists
    label: str
    colour: str
    dashes: Dashes
    width: float
    zorder: float


CURED = Trace("cured", "estimate, cured", BLUE, "-", 2.2, 3.0)
LOST = Trace("lost", "estimate as it stands", VERMILLION, (0, (4, 1.5)), 1.8, 3.2)


def from_where_they_part(steps: Sequence[Step], parts_at: int | None) -> list[Step]:
    """The steps since the one before they part; all of them where it is not known."""
    return [step for step in steps if parts_at is None or step.entry.index >= parts_at - 1]


def draw_estimate(
    axes: Axes, trace: Trace, steps: Sequence[Step], probability: float, size: float
) -> None:
    """The way of an estimate, ellipses on it, and where it ends. size : m, of the picture"""
    poses = np.array([posed(step.posterior, step.layout).mean for step in steps])
    axes.plot(
        *poses[:, :2].T, color=trace.colour, ls=trace.dashes, lw=trace.width, zorder=trace.zorder,
        label=trace.label, gid=f"{trace.name}-way",
    )  # fmt: skip
    for number, step in enumerate(ellipsed(steps)):
        x, P = posed(step.posterior, step.layout)
        axes.fill(
            *outline(x, P[:2, :2], probability).T, facecolor=(*_rgb(trace.colour), 0.07),
            edgecolor=trace.colour, ls=trace.dashes, lw=0.9, zorder=trace.zorder - 0.1,
            gid=f"{trace.name}-ellipse-{number}",
            label=f"its {100 * probability:.4g} % ellipse",
        )  # fmt: skip
    axes.fill(
        *robot(poses[-1], BODY * size).T, facecolor=trace.colour, edgecolor="white", lw=0.5,
        zorder=trace.zorder + 0.5, gid=f"{trace.name}-end",
    )  # fmt: skip


def draw_truths(axes: Axes, lost: Sequence[Step], cured: Sequence[Step], size: float) -> None:
    """Where the robot truly was, and where it ends; of the cured run as well where that was
    elsewhere, as without a slip.
    """
    way, other = true_way(lost), true_way(cured)
    if not len(way):
        return
    if len(other) and not np.array_equal(other, way):
        axes.plot(*other[:, :2].T, color=BLUE, lw=1.2, ls=(0, (1.2, 1.6)), zorder=3.3,
                  label="true way, cured", gid="cured-true-way")  # fmt: skip
    axes.plot(*way[:, :2].T, color=TRUTH, lw=1.2, ls=(0, (1.2, 1.6)), zorder=3.4,
              label="true way", gid="true-way")  # fmt: skip
    axes.fill(*robot(way[-1], BODY * size).T, facecolor="none", edgecolor=TRUTH, lw=1.2, zorder=4.0,
              gid="true-end")  # fmt: skip


def true_way(steps: Sequence[Step]) -> Array:
    """The true poses : (n, 3), none where the truth is not known"""
    known = [step.entry.truth for step in steps if step.entry.truth is not None]
    return np.array(known).reshape(-1, 3)


def draw_beam(axes: Axes, beam: Met) -> None:
    """The beam that did it: as predicted and as measured from the estimate, and as it was."""
    start, along = beam.pose[:2], direction(beam.pose[2])
    if np.isfinite(beam.measured):
        end = start + beam.measured * along
        axes.plot(*np.stack([start, end]).T, color=ORANGE, lw=1.6, zorder=3.6,
                  label=f"beam of step {beam.step}, as measured", gid="beam-measured")  # fmt: skip
        axes.plot(*end, marker="o", ms=7, mfc="none", mec=ORANGE, mew=1.8, ls="", zorder=3.7,
                  gid="measured-end")  # fmt: skip
    if np.isfinite(beam.predicted):
        axes.plot(
            *(start + beam.predicted * along), marker="X", ms=9, mfc=ORANGE, mec="black", mew=0.8,
            ls="", zorder=4.2, label="where it was predicted to end", gid="predicted-end",
        )  # fmt: skip
    if beam.truth is not None and np.isfinite(beam.range):
        from_, met = beam.truth[:2], beam.truth[:2] + beam.range * direction(beam.truth[2])
        axes.plot(*np.stack([from_, met]).T, color=TRUTH, lw=0.9, ls=":", zorder=3.5,
                  gid="beam-true")  # fmt: skip
        axes.plot(*met, marker="s", ms=6, mfc="none", mec=TRUTH, mew=1.3, ls="", zorder=4.1,
                  label="where it truly ended", gid="true-wall")  # fmt: skip


def reached(beam: Met) -> Array:
    """The ends of a beam : (n, 2) m"""
    start, along = beam.pose[:2], direction(beam.pose[2])
    ends = [start, *(start + r * along for r in (beam.measured, beam.predicted))]
    if beam.truth is not None:
        ends += [beam.truth[:2], beam.truth[:2] + beam.range * direction(beam.truth[2])]
    each = np.array(ends)
    return each[np.isfinite(each).all(axis=-1)]


def ellipsed(steps: Sequence[Step]) -> list[Step]:
    """The steps whose ellipses are drawn: the last before each move, of many some at even
    distances, and always the last of all.
    """
    before_moves = list(_before_moves(steps))
    if len(before_moves) <= MOST_ELLIPSES:
        return before_moves
    chosen = np.linspace(0, len(before_moves) - 1, MOST_ELLIPSES).round().astype(int)
    return [before_moves[i] for i in chosen]


def _before_moves(steps: Sequence[Step]) -> Iterator[Step]:
    for step, following in zip(steps, [*steps[1:], None], strict=True):
        if following is None or isinstance(following.entry.command, Move):
            yield step


def _rgb(colour: str) -> tuple[float, float, float]:
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue
