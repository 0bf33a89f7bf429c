"""Areas in their own style while the truth is inside, in that of a warning while it is not."""

from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from ekfsim.geometry import Array
from ekfsim.views.picture.artists import NOWHERE, VERMILLION, Dashes, area, empty

ALARM = VERMILLION
ALARM_DASHES: Dashes = (0, (5, 1.6, 1.2, 1.6))  # as nothing else is drawn, for a print in grey
ALARM_WIDTH, ALARM_FILL = 2.2, 0.12


class EitherArea:
    """An area in one of two styles, each with an artist of its own, of which one is seen."""

    def __init__(self, usual: Polygon, other: Polygon) -> None:
        self._usual, self._other = usual, other

    def show(self, points: Array, other: bool) -> None:
        """Move it. points : (n, 2) m; other : whether in the other style"""
        seen, hidden = (self._other, self._usual) if other else (self._usual, self._other)
        seen.set_xy(points)
        if not empty(hidden):
            hidden.set_xy(NOWHERE)


def alarm(axes: Axes, calm: Polygon) -> Polygon:
    """What is seen in the place of an area while the truth is outside of it."""
    return area(
        axes, ALARM, ALARM_FILL, ALARM_DASHES, ALARM_WIDTH, calm.get_zorder() + 0.05,
        f"{calm.get_gid()}-outside", "the truth is outside",
    )  # fmt: skip
