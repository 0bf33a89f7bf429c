"""The picture of a comparison: who is lost over the steps,
how far off the runs end, and what differs.
"""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ekfsim.study.comparison import Comparison
from ekfsim.study.pairs import PER_OCTAVE, Pairs
from ekfsim.study.results import Result
from ekfsim.version import VERSION
from ekfsim.views.picture.written.lettering import drawable, wrapped
from ekfsim.views.study.compare_words import measures, sentence, settings
from ekfsim.views.study.sheet import PENS, Pen, draw_shares, panel, save, sheet

SIZE = (8.0, 7.4)  # in
LETTERS = 120  # in a line of the sentences


def draw_comparison(comparison: Comparison, found: Pairs, path: Path) -> None:
    """Draw the picture into a PNG file."""
    save(picture(comparison, found), path, told(comparison))


def picture(comparison: Comparison, found: Pairs) -> Figure:
    """Three panels: lost over the steps, the last position errors, the sentences."""
    figure = sheet(*SIZE, "Two settings on the same draws, with 95 % intervals", told(comparison))
    lost, errors, words = figure.subplots(3, 1, height_ratios=[1, 1, 0.3])
    sides = (
        ("a", comparison.a, found.a, found.a_errors),
        ("b", comparison.b, found.b, found.b_errors),
    )
    for (name, plan, tally, octaves), pen in zip(sides, PENS, strict=False):
        label = drawable(f"{name}: {settings(plan, comparison)}")
        steps = Result(plan.cases[0], tally).steps
        x = [at.step if math.isnan(at.t) else at.t for at in steps]
        draw_shares(lost, x, [at.lost for at in steps], pen, label)
        _spread(errors, octaves, pen, label)
    panel(lost, "runs that are lost for good")
    panel(errors, "distance from the truth at the last step, runs by its size")
    lost.set_ylim(bottom=0)
    clocked = not math.isnan(found.a.times[-1])
    lost.set_xlabel("t (s)" if clocked else "step")
    errors.set(xscale="log", xlabel="position error (m)")
    lost.legend(loc="best", fontsize=8, framealpha=0.9)
    words.axis("off")
    said = [sentence(measure) for measure in measures(found) if not math.isnan(measure.found.value)]
    lines = wrapped(map(drawable, said), LETTERS, 2 * len(said))
    words.text(0.0, 1.0, "\n".join(lines), fontsize=8, va="top", transform=words.transAxes)
    return figure


def told(comparison: Comparison) -> str:
    """What made the picture, in a line."""
    request, scene = comparison.request, comparison.a.cases[0].scene
    facts = [
        f"ekfsim {VERSION}", f"world {scene.world_source}", f"commands {scene.commands_source}",
        f"{request.runs} runs",
        f"seed {comparison.a.seed}", *(f"set {one}" for one in request.settings),
        f"a: {settings(comparison.a, comparison)}", f"b: {settings(comparison.b, comparison)}",
    ]  # fmt: skip
    return ", ".join(facts)


def _spread(axes: Axes, octaves: Mapping[int, int], pen: Pen, label: str) -> None:
    """How many of the runs end how far off."""
    if not octaves:
        return
    bins = np.arange(min(octaves), max(octaves) + 1)
    counts = np.array([octaves.get(bin, 0) for bin in bins.tolist()])
    edges = 2.0 ** (np.append(bins, bins[-1] + 1) / PER_OCTAVE)
    axes.stairs(
        counts / counts.sum(), edges, color=pen.colour, ls=pen.style, lw=pen.width, label=label
    )
