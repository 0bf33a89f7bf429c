"""What the pictures of studies and comparisons are drawn on:
a sheet with its foot, and panels of shares in percent.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import PercentFormatter

from ekfsim.geometry import Array
from ekfsim.study.results import Share
from ekfsim.version import VERSION
from ekfsim.views.picture.written.lettering import drawable, wrapped

GREY = "#666666"
DPI = 120
FOOT, FOOT_LINES = 0.24, 2  # in, for the lines that tell what made it
FOOT_LETTERS, TITLE_LETTERS = 21, 10  # to an inch


class Pen(NamedTuple):
    """How a line is drawn. Where two lie on one another the lower is seen between the dashes of the
    upper.
    """

    colour: str
    style: str | tuple[int, tuple[float, ...]]
    width: float


PENS = (
    Pen("#0072B2", "-", 2.4),
    Pen("#D55E00", (0, (4, 1.5)), 1.8),
    Pen("#009E73", (0, (1, 1.2)), 2.2),
    Pen("#CC79A7", (0, (6, 1.5, 1, 1.5)), 1.5),
    Pen("#E69F00", "-", 0.9),
)


def sheet(width: float, height: float, title: str, told: str) -> Figure:
    """A figure that no window manages. width, height : in; told : what made it, for its foot"""
    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    engine = figure.get_layout_engine()
    assert isinstance(engine, ConstrainedLayoutEngine)
    engine.set(rect=(0, FOOT / height, 1, 1 - FOOT / height))
    figure.suptitle("\n".join(wrapped([title], int(TITLE_LETTERS * width), 2)), fontsize=12)
    lines = wrapped([drawable(told)], int(FOOT_LETTERS * width), FOOT_LINES)
    figure.text(0.995, 0.004, "\n".join(lines), fontsize=5.5, ha="right", va="bottom", color=GREY)
    return figure


def save(figure: Figure, path: Path, told: str) -> None:
    """Write a picture as PNG, with the same in its notes."""
    notes = {"Software": f"ekfsim {VERSION}", "Description": told}
    figure.savefig(path, dpi=DPI, format="png", metadata=notes)


def panel(axes: Axes, title: str) -> None:
    """A title, an axis in percent, and a light grid."""
    axes.set_title(title, fontsize=10, loc="left")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.grid(True, color="#DDDDDD", lw=0.6)
    axes.set_axisbelow(True)


def draw_shares(
    axes: Axes, x: Sequence[float], shares: Sequence[Share], pen: Pen, label: str, marker: str = ""
) -> None:
    """A line of shares, its 95 % interval as a band."""
    y = numbers(shares)
    axes.plot(
        x, y[:, 0], color=pen.colour, ls=pen.style, lw=pen.width, marker=marker, ms=3, label=label
    )
    axes.fill_between(x, y[:, 1], y[:, 2], color=pen.colour, alpha=0.2, lw=0)


def numbers(shares: Sequence[Share]) -> Array:
    """Each share with the ends of its interval : (n, 3)"""
    return np.array([(share.value, share.low, share.high) for share in shares])
