"""Lost run and cured run over each other from the step where they part, and the NEES of both."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ekfsim.diagnostics.verdict import LOST as LOST_QUANTILE
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import posed
from ekfsim.geometry import Array
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Step
from ekfsim.views.film.still import save
from ekfsim.views.picture.artists import WorldArtists
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.panels import in_metres
from ekfsim.views.picture.written.lettering import drawable
from ekfsim.views.study.sheet import GREY, sheet
from ekfsim.views.why.answer import cause
from ekfsim.views.why.mechanisms import beam_of, culprit
from ekfsim.views.why.met import Met
from ekfsim.views.why.traces import (
    CURED,
    LOST,
    Trace,
    draw_beam,
    draw_estimate,
    draw_truths,
    from_where_they_part,
    reached,
)
from ekfsim.views.words.numbers import length
from ekfsim.why.records import Explanation

WIDTH, LEGEND, HEADS = 9.0, 2.6, 0.9  # in: the figure, its legend, title and foot
LEAST_MAP, MOST_MAP, CURVE = 1.6, 6.2, 2.1  # in: the map's height, from and to, and the curve's
AROUND = 0.25  # of the longer side of what is drawn: what is shown around it
LEAST = 0.05  # of the world's longer side: what is drawn counts as at least so long
CLOSE = 0.45  # of the same: what is smaller is shown without the rest of the world
WIDEST = 2.5  # one side by the other, of a part of the world
EDGE = 0.03  # of the longer side, around what reaches out of the world
REACH = 2.5  # standard deviations, to the end of an ellipse
BEYOND = 0.8  # of the longer side: how far what leaves the world is followed
FINE = "#DDDDDD"
NAMED = (  # what the legend explains, in the order of drawing
    *("true-way", "cured-true-way", "cured-way", "cured-ellipse-0", "lost-way", "lost-ellipse-0"),
    *("beam-measured", "predicted-end", "true-wall"),
)
LEAST_NEES = 1e-2  # what is less lies at the lower edge


def draw_why(found: Explanation, target: Path, probability: float, force: bool = False) -> None:
    """Write the picture. Raises UsageError where the file is of another kind, or exists."""
    title = f"{found.scene.commands_source}: {cause(found)}"
    save(picture(found, probability), target, title, told_in_a_line(found.scene), force)


def picture(found: Explanation, probability: float = 0.954) -> Figure:
    """The map above, NEES of both runs below."""
    beam = beam_of(found)
    lost = from_where_they_part(found.lost_steps, found.parts_at)
    cured = from_where_they_part(found.cured_steps, found.parts_at)
    limits = shown(found, lost, cured, beam)
    high = min(max((WIDTH - LEGEND - 1.0) / limits.shape, LEAST_MAP), MOST_MAP)
    title = drawable(f"{found.scene.commands_source}, run {found.scene.run}: {cause(found)}")
    figure = sheet(WIDTH, high + CURVE + HEADS, title, told_in_a_line(found.scene))
    grid = figure.add_gridspec(2, 1, height_ratios=[high, CURVE])
    upper, lower = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
    draw_map(upper, found, lost, cured, beam, limits, probability)
    draw_nees(lower, found)
    return figure


def draw_map(
    axes: Axes, found: Explanation, lost: Sequence[Step], cured: Sequence[Step], beam: Met | None,
    limits: Limits, probability: float,
) -> None:  # fmt: skip
    """World, truth, both estimates and the beam that did it."""
    world = WorldArtists(axes, found.scene.world)
    draw_truths(axes, lost, cured, limits.size)
    for trace, steps in ((CURED, cured), (LOST, lost)):
        if steps:
            draw_estimate(axes, trace, steps, probability, limits.size)
    if beam is not None:
        draw_beam(axes, beam)
    mark_step(axes, found, beam)
    axes.set(
        xlim=(limits.left, limits.right), ylim=(limits.bottom, limits.top), aspect="equal",
        title=headline(found, lost, limits),
    )  # fmt: skip
    axes.title.set_fontsize(10)
    in_metres(axes)
    drawn = [one for one in axes.get_children() if one.get_gid() in NAMED]
    handles = {str(one.get_label()): one for one in (*drawn, *world.handles())}
    axes.legend(
        handles.values(), handles.keys(), loc="upper left", bbox_to_anchor=(1.01, 1.0),
        borderaxespad=0.0, fontsize=8, frameon=False,
    )  # fmt: skip


def headline(found: Explanation, lost: Sequence[Step], limits: Limits) -> str:
    """From where on the two are drawn, and whether an estimate leaves the picture."""
    told = "the whole run"
    if found.cured_steps and found.parts_at is not None:
        told = f"from step {found.parts_at}, where the two runs part"
    way = [posed(step.posterior, step.layout).mean[:2] for step in lost]
    if way and not limits.hold(np.array(way)):
        far = max(map(astray, lost))
        told += f"; the estimate leaves the picture, up to {length(far)} from the truth"
    return told


def astray(step: Step) -> float:
    """How far an estimate is from the truth, in m; 0 where that is not known."""
    if step.entry.truth is None:
        return 0.0
    return math.dist(posed(step.posterior, step.layout).mean[:2], step.entry.truth[:2])


def mark_step(axes: Axes, found: Explanation, beam: Met | None) -> None:
    """Where the step was at which they part."""
    step = culprit(found)
    if step is None:
        return
    x = step.layout.pose(step.posterior.mean if beam is None else step.prior.mean)
    axes.annotate(
        f"step {step.entry.index}", tuple(x[:2].tolist()), (10, 10), textcoords="offset points",
        fontsize=9, weight="bold", zorder=6, gid="step",
        arrowprops={"arrowstyle": "-", "lw": 0.8}, annotation_clip=True,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1},
    )  # fmt: skip


def shown(
    found: Explanation, lost: Sequence[Step], cured: Sequence[Step], beam: Met | None
) -> Limits:
    """The world, both runs and the beam, or as much of the world as these are in; of what goes far
    astray as much as leaves the world readable.
    """
    base = scopes.of(found.scene, lost or found.lost_steps).base
    far = base.grown(BEYOND * base.size)
    drawn = [places(steps) for steps in (lost, cured) if steps]
    drawn += [] if beam is None else [reached(beam)]
    needed = Limits.around(np.vstack(drawn)) if drawn else base
    needed = needed.cut(far) if needed.meets(far) else base
    close = needed.grown(AROUND * max(needed.size, LEAST * base.size))
    if close.size < CLOSE * base.size:
        return close.shaped(min(max(close.shape, 1 / WIDEST), WIDEST))
    return base.joined(needed.grown(EDGE * base.size))


def places(steps: Sequence[Step]) -> Array:
    """All that is drawn of steps: true and estimated positions, and the ends of ellipses : (n, 2)
    m
    """
    made: list[Array] = []
    for step in steps:
        x, P = posed(step.posterior, step.layout)
        half = REACH * np.sqrt(np.diag(P)[:2])
        made += [x[:2] - half, x[:2] + half]
        made += [] if step.entry.truth is None else [step.entry.truth[:2]]
    return np.array(made)


def draw_nees(axes: Axes, found: Explanation) -> None:
    """NEES after each step of both runs, and the bound beyond which one is lost."""
    each = [(CURED, found.cured_steps), (LOST, found.lost_steps)]
    most = 0.0
    for trace, steps in each:
        judged = [step for step in steps if step.nees is not None]
        if judged:
            most = max(most, _draw_run(axes, trace, judged))
    known = [step for step in found.lost_steps if step.nees is not None]
    if not known:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "the truth is not known: there is no NEES", ha="center", va="center")
        return
    at = np.array([step.entry.index for step in known])
    bounds = np.array([quantile(LOST_QUANTILE, _dof(step)) for step in known])
    axes.step(at, bounds, where="mid", color="#333333", lw=0.9, ls="-.",
              label="99.9 %: beyond, it is lost", gid="bound")  # fmt: skip
    if found.parts_at is not None and found.cure:
        axes.axvline(found.parts_at, color=GREY, lw=1.2, ls=":", gid="parts",
                     label=f"step {found.parts_at}: they part")  # fmt: skip
    if found.lost_from is not None:
        axes.axvspan(found.lost_from, at[-1], color=LOST.colour, alpha=0.08, lw=0, gid="lost-span",
                     label=f"lost since step {found.lost_from}")  # fmt: skip
    axes.set(xlabel="step", ylabel="NEES", xlim=(at[0], max(at[-1], at[0] + 1)))
    if most > 5 * bounds.max():
        axes.set_yscale("log")
        axes.set_ylim(LEAST_NEES, 3 * most)
    else:
        axes.set_ylim(0, 1.1 * max(most, float(bounds.max())))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=(1, 2, 5, 10)))
    axes.grid(True, color=FINE, lw=0.6)
    axes.set_axisbelow(True)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0, fontsize=8,
                frameon=False)  # fmt: skip


def _draw_run(axes: Axes, trace: Trace, steps: Sequence[Step]) -> float:
    """One line; the largest NEES on it."""
    at = np.array([step.entry.index for step in steps])
    values = np.array([_nees(step) for step in steps])
    axes.plot(
        at, np.maximum(values, LEAST_NEES), color=trace.colour, ls=trace.dashes, lw=trace.width,
        zorder=trace.zorder, label=trace.label.replace("estimate", "NEES"),
        gid=f"{trace.name}-nees",
    )  # fmt: skip
    return float(np.nanmax(values, initial=0.0))


def _nees(step: Step) -> float:
    assert step.nees is not None
    return math.nan if step.nees.impossible else float(step.nees.value)


def _dof(step: Step) -> int:
    assert step.nees is not None
    return max(int(step.nees.dof), 1)
