"""The picture of a comparison: who is lost over the steps, how far off the runs end, and what differs."""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from ekfsim.study.comparison import Comparison
from ekfsim.study.pairs import PER_OCTAVE, Pairs
from ekfsim.study.plan import Plan
from ekfsim.study.results import Result
from ekfsim.study.tally import Tally
from ekfsim.version import VERSION
from ekfsim.views.compare_words import measures, sentence, settings
from ekfsim.views.lettering import drawable, wrapped
from ekfsim.views.study_pictures import COLOURS, DPI, GREY, sheet

SIZE = (8.0, 7.4)  # in
LETTERS = 120  # in a line of the sentences
STYLES = (("a", COLOURS[0], "-"), ("b", COLOURS[1], (0, (4, 1.5))))


def draw_comparison(comparison: Comparison, found: Pairs, path: Path) -> None:
    """Draw the picture into a PNG file."""
    notes = {"Software": f"ekfsim {VERSION}", "Description": told(comparison)}
    picture(comparison, found).savefig(path, dpi=DPI, metadata=notes)


def picture(comparison: Comparison, found: Pairs) -> Figure:
    """Three panels: lost over the steps, the last position errors, the sentences."""
    figure = sheet(*SIZE)
    lost, errors, words = figure.subplots(3, 1, height_ratios=[1, 1, 0.3])
    pairs = ((comparison.a, found.a, found.a_errors), (comparison.b, found.b, found.b_errors))
    for (name, colour, style), (plan, tally, octaves) in zip(STYLES, pairs, strict=True):
        label = drawable(f"{name}: {settings(plan, comparison)}")
        _over_steps(lost, plan, tally, colour, style, label)
        _spread(errors, octaves, colour, style, label)
    _frame(lost, "runs that are lost for good")
    _frame(errors, "distance from the truth at the last step, runs by its size")
    lost.set_ylim(bottom=0)
    clocked = not math.isnan(found.a.times[-1])
    lost.set_xlabel("t (s)" if clocked else "step")
    errors.set(xscale="log", xlabel="position error (m)")
    lost.legend(loc="best", fontsize=8, framealpha=0.9)
    words.axis("off")
    said = [sentence(measure) for measure in measures(found) if not math.isnan(measure.found.value)]
    lines = wrapped(map(drawable, said), LETTERS, 2 * len(said))
    words.text(0.0, 1.0, "\n".join(lines), fontsize=8, va="top", transform=words.transAxes)
    figure.suptitle("Two settings on the same draws, with 95 % intervals", fontsize=12)
    lines = wrapped([drawable(told(comparison))], int(21 * SIZE[0]), 2)
    figure.text(0.995, 0.004, "\n".join(lines), fontsize=5.5, ha="right", va="bottom", color=GREY)
    return figure


def told(comparison: Comparison) -> str:
    """What made the picture, in a line."""
    request, scene = comparison.request, comparison.a.cases[0].scene
    facts = [
        f"ekfsim {VERSION}", f"world {scene.world_source}", f"commands {scene.commands_source}", f"{request.runs} runs",
        f"seed {comparison.a.seed}", *(f"set {one}" for one in request.settings),
        f"a: {settings(comparison.a, comparison)}", f"b: {settings(comparison.b, comparison)}",
    ]  # fmt: skip
    return ", ".join(facts)


def _over_steps(axes: Axes, plan: Plan, tally: Tally, colour: str, style: object, label: str) -> None:
    """The share that is lost from each step or an earlier one to the end, its interval as a band."""
    steps = Result(plan.cases[0], tally).steps
    x = [at.step if math.isnan(at.t) else at.t for at in steps]
    y = np.array([(at.lost.value, at.lost.low, at.lost.high) for at in steps])
    axes.plot(x, y[:, 0], color=colour, ls=style, lw=1.6, label=label)
    axes.fill_between(x, y[:, 1], y[:, 2], color=colour, alpha=0.2, lw=0)


def _spread(axes: Axes, octaves: Mapping[int, int], colour: str, style: object, label: str) -> None:
    """How many of the runs end how far off."""
    if not octaves:
        return
    bins = np.arange(min(octaves), max(octaves) + 1)
    counts = np.array([octaves.get(bin, 0) for bin in bins.tolist()])
    edges = 2.0 ** (np.append(bins, bins[-1] + 1) / PER_OCTAVE)
    axes.stairs(counts / counts.sum(), edges, color=colour, ls=style, lw=1.6, label=label)


def _frame(axes: Axes, title: str) -> None:
    axes.set_title(title, fontsize=10, loc="left")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.grid(True, color="#DDDDDD", lw=0.6)
    axes.set_axisbelow(True)
