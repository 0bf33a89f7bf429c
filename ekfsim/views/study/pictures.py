"""The three pictures of a study: NEES against χ², coverage, and divergence;
over the steps or over what was swept.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.ticker import PercentFormatter

from ekfsim.files.yaml.marked import scalar
from ekfsim.geometry import Array
from ekfsim.study.plan import Plan
from ekfsim.study.results import AtStep, Result, Share
from ekfsim.study.verdict import MOST_LOST
from ekfsim.version import VERSION
from ekfsim.views.picture.written.lettering import wrapped
from ekfsim.views.study.sheet import GREY, PENS, draw_shares, numbers, panel, save, sheet

FAINT = 0.1  # how far from where it should be a share must lie to have the deepest colour of a map
MOST_MAPS = 12  # of two swept keys, in one row of pictures
# values that reach so many times as far; values that are all written at the axis
LOGARITHMIC, MOST_TICKS = 20, 8
MOST_MARKED = 60  # steps of which each has a dot
LETTER = 0.075  # in, of the name of a key beside a map


@dataclass(frozen=True)
class Quantity:
    """One share that is drawn, and where it should lie."""

    title: str
    of: Callable[[AtStep], Share]
    meant: float
    meant_words: str
    colours: str = "RdBu_r"  # of a map: red is over-confident, blue over-cautious


LOST = Quantity("lost for good", lambda at: at.lost, MOST_LOST, "2 %: no longer consistent", "Reds")
PICTURES: dict[str, tuple[str, tuple[Quantity, ...]]] = {
    "nees": (
        "Runs whose NEES lies above a quantile of χ²",
        (
            Quantity(
                "above the median", lambda at: at.above_50, 0.5, "50 %, where the filter is honest"
            ),
            Quantity(
                "above the 95 % quantile",
                lambda at: at.above_95,
                0.05,
                "5 %, where the filter is honest",
            ),
            Quantity(
                "above the 99.9 % quantile",
                lambda at: at.above_999,
                0.001,
                "0.1 %, where the filter is honest",
            ),
        ),
    ),
    "coverage": (
        "Runs whose truth lies inside the 95.4 % ellipse and cone",
        (
            Quantity("position inside the ellipse", lambda at: at.ellipse, 0.954, "95.4 %", "RdBu"),
            Quantity("heading inside the cone", lambda at: at.cone, 0.954, "95.4 %", "RdBu"),
        ),
    ),
    "divergence": ("Runs that are lost", (LOST,)),
}


def draw_study(plan: Plan, results: Sequence[Result], folder: Path) -> None:
    """Draw nees.png, coverage.png and divergence.png into a folder."""
    for name, (title, quantities) in PICTURES.items():
        save(picture(plan, results, title, quantities), folder / f"{name}.png", told(plan))


def picture(
    plan: Plan, results: Sequence[Result], title: str, quantities: Sequence[Quantity]
) -> Figure:
    """One picture: lines over the steps where nothing is swept,
    over the values of one key, maps for more.
    """
    if plan.keys:
        title = f"{title}, at the last step"
    if len(plan.keys) > 1:
        return _maps(plan, results, title, quantities)
    figure = sheet(
        8.0, 1.0 + 2.3 * len(quantities) + (1.2 if len(quantities) == 1 else 0), title, told(plan)
    )
    rows = figure.subplots(len(quantities), 1, sharex=True, squeeze=False)[:, 0]
    for axes, quantity in zip(rows, quantities, strict=True):
        if plan.keys:
            _over_values(axes, plan, results, quantity)
        else:
            _over_steps(axes, results, quantity)
        axes.set_title(f"grey line: {quantity.meant_words}", fontsize=8, loc="right", color=GREY)
    rows[0].legend(  # above its title: on the lines it would hide some
        loc="lower left",
        bbox_to_anchor=(0, 1),
        borderaxespad=2.2,
        ncols=len(PENS),
        fontsize=8,
        frameon=False,
    )
    return figure


def told(plan: Plan) -> str:
    """What made a picture, in a line."""
    request, scene = plan.request, plan.cases[0].scene
    facts = [
        f"ekfsim {VERSION}", f"world {scene.world_source}", f"commands {scene.commands_source}",
        f"{request.runs} runs",
        f"seed {plan.seed}", f"filter {','.join(plan.called)}", f"gate {scene.gate}",
        f"guard {scene.guard}",
    ]  # fmt: skip
    facts += [f"set {one}" for one in request.settings]
    facts += [
        f"sweep {values[0].key}={','.join(one.value for one in values)}" for values in request.sweep
    ]
    swept = set(plan.keys)
    return ", ".join(
        f for f in facts if f.partition(" ")[0] not in swept and not f.endswith(" None")
    )


def _over_steps(axes: Axes, results: Sequence[Result], quantity: Quantity) -> None:
    """A line for each filter, its interval as a band."""
    clocked = not math.isnan(results[0].last.t)
    for result, pen in zip(results, PENS, strict=False):
        x = [at.t if clocked else at.step for at in result.steps]
        marker = "o" if len(x) < MOST_MARKED else ""
        draw_shares(
            axes, x, [quantity.of(at) for at in result.steps], pen, result.case.filter, marker
        )
    _frame(axes, quantity)
    if axes.get_subplotspec().is_last_row():  # type: ignore[union-attr]  # each has one
        axes.set_xlabel("t (s)" if clocked else "step")


def _over_values(axes: Axes, plan: Plan, results: Sequence[Result], quantity: Quantity) -> None:
    """The last step over the swept values: a line for each filter, its intervals as bars."""
    values = [one.value for one in plan.request.sweep[0]]
    known = [value for value in map(scalar, values) if isinstance(value, int | float)]
    metric = len(known) == len(values)  # words stand in their order
    x = np.array(known if metric else range(len(values)), float)
    order = np.argsort(x)
    for pen, name in zip(PENS, plan.called, strict=False):
        y = numbers([quantity.of(result.last) for result in results if result.case.filter == name])[
            order
        ]
        bars = np.maximum(np.abs(y[:, 1:].T - y[:, 0]), 0.0)
        axes.errorbar(
            x[order], y[:, 0], bars, color=pen.colour, ls=pen.style, lw=pen.width, elinewidth=1.2,
            marker="o", ms=4,
            capsize=3, label=name,
        )  # fmt: skip
    if metric and x.min() > 0 and x.max() / x.min() > LOGARITHMIC:
        axes.set_xscale("log")
    if not metric or len(values) <= MOST_TICKS:
        axes.set_xticks(x, values)
        axes.minorticks_off()
    _frame(axes, quantity)
    if axes.get_subplotspec().is_last_row():  # type: ignore[union-attr]  # each has one
        axes.set_xlabel(plan.keys[0])


def _frame(axes: Axes, quantity: Quantity) -> None:
    """Where the share should lie, and axes in percent from what is least to what is most."""
    axes.axhline(quantity.meant, color=GREY, lw=1, ls="--")
    low, high = axes.get_ylim()
    axes.set_ylim(max(low, -0.02), min(high, 1.02))
    panel(axes, quantity.title)


def _maps(
    plan: Plan, results: Sequence[Result], heading: str, quantities: Sequence[Quantity]
) -> Figure:
    """Heat maps of the last two swept keys:
    a row for each quantity, a column for each filter and other values.
    """
    held = list(_columns(plan, results))
    down, across = ([one.value for one in values] for values in plan.request.sweep[-2:])
    shown = held[:MOST_MAPS]
    wide, inside = max(0.62 * len(across), 2.2) + 0.9, max(0.36 * len(down), 1.4)
    beside = (
        plan.keys[-2]
        if LETTER * len(plan.keys[-2]) < inside
        else plan.keys[-2].replace(".", ".\n", 1)
    )
    width, height = max(wide * len(shown) + 0.9, 6.0), (inside + 0.9) * len(quantities) + 0.7
    figure = sheet(width, height, heading, told(plan))
    grid = figure.subplots(len(quantities), len(shown), squeeze=False, sharex=True, sharey=True)
    for row, quantity in zip(grid, quantities, strict=True):
        shares = [
            np.array([quantity.of(result.last).value for result in cells]) for _, cells in shown
        ]
        norm = _norm(quantity, np.concatenate(shares))
        for axes, (name, _), column in zip(row, shown, shares, strict=True):
            image = _map(axes, column.reshape(len(down), len(across)), norm, quantity.colours)
            title = f"{name}\n{quantity.title}" if len(quantities) > 1 else name
            axes.set_title("\n".join(wrapped(title.split("\n"), int(13 * wide), 6)), fontsize=9)
            axes.set_xticks(range(len(across)), across, rotation=45 if len(across) > 6 else 0)
            axes.set_yticks(range(len(down)), down)
        row[0].set_ylabel(beside, fontsize=9)
        bar = figure.colorbar(image, ax=row.tolist(), format=PercentFormatter(1.0, symbol=" %"))
        bar.ax.set_ylim(max(norm.vmin or 0.0, 0.0), min(norm.vmax or 1.0, 1.0))
    grid[-1][(len(shown) - 1) // 2].set_xlabel(plan.keys[-1])
    if len(held) > len(shown):
        figure.text(
            0.005,
            0.004,
            f"{len(shown)} of {len(held)} maps; summary.csv holds all",
            fontsize=7,
            va="bottom",
        )
    return figure


def _columns(plan: Plan, results: Sequence[Result]) -> Iterator[tuple[str, list[Result]]]:
    """The rows of each map, by the filter and the values of the keys before the last two."""
    found: dict[str, list[Result]] = {}
    for result in results:
        name = ", ".join([result.case.filter, *map(str, result.case.values[:-2])])
        found.setdefault(name, []).append(result)
    yield from found.items()


def _norm(quantity: Quantity, shares: Array) -> Normalize:
    """How shares become colours: white is as it should be,
    and as deep for as much too many as for too few.
    """
    known = shares[~np.isnan(shares)].tolist()
    if quantity.colours == "Reds":
        return Normalize(0.0, max([2 * quantity.meant, *known]))
    reach = max([FAINT, *(abs(share - quantity.meant) for share in known)])
    return Normalize(quantity.meant - reach, quantity.meant + reach)


def _map(axes: Axes, shares: Array, norm: Normalize, colours: str) -> AxesImage:
    """A heat map with its numbers in percent."""
    image = axes.imshow(shares, aspect="auto", cmap=colours, norm=norm, origin="lower")
    for (i, j), value in np.ndenumerate(shares):
        r, g, b, _ = image.to_rgba(np.array(value))
        dark = 0.299 * r + 0.587 * g + 0.114 * b < 0.5
        text = "-" if math.isnan(value) else f"{100 * value:.1f}"
        axes.text(
            j, i, text, ha="center", va="center", fontsize=8, color="white" if dark else "black"
        )
    return image
