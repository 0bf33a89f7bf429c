"""How the lines of each filter are told from the others': by colour and by dashes."""

from typing import NamedTuple

from matplotlib.axes import Axes

from ekfsim.views.picture.artists import BLUE, Dashes
from ekfsim.views.picture.belief.others import STYLES

FINE = "#DDDDDD"


class Pen(NamedTuple):
    """How a filter's lines and dots are drawn; as its ellipse is in the picture of a step.

    The first has the broadest line: it is seen between the dashes of those that lie on it.
    """

    colour: str
    dashes: Dashes
    marker: str
    width: float


def pen(number: int) -> Pen:
    """That of each filter that watches, counted from 0."""
    if number == 0:
        return Pen(BLUE, "-", "o", 1.8)
    style = STYLES[(number - 1) % len(STYLES)]
    return Pen(style.color, style.dashes, style.marker, 1.3)


def ruled(axes: Axes, quantity: str) -> None:
    """Axes over the steps with the name of what is drawn, and a light grid."""
    axes.set_ylabel(quantity)
    axes.grid(True, color=FINE, lw=0.6)
    axes.set_axisbelow(True)
