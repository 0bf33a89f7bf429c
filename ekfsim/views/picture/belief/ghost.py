"""What was believed before the step that a view shows: thin outlines, in grey."""

from collections.abc import Iterator

from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ekfsim.geometry.ellipse import cone_halfwidth, outline
from ekfsim.views.picture.artists import CONE, NOWHERE, closed, line, place, sector
from ekfsim.views.playback.view import View

GHOST = "#7A7A7A"


class GhostArtists:
    """Ellipse and cone as they were: of the prior beside a revised estimate, of the last estimate
    beside a predicted one.
    """

    def __init__(self, axes: Axes, probability: float) -> None:
        self._probability = probability
        self.ellipse = line(axes, "ghost", "belief before", 3.15, GHOST, 0.9)
        self.cone = line(axes, "ghost-cone", "", 2.05, GHOST, 0.7)

    def show(self, view: View, unit: float) -> None:
        """Move them. unit : m, what the robot's body measures in this Axes"""
        if view.earlier is None:
            place(self.ellipse, NOWHERE)
            place(self.cone, NOWHERE)
            return
        x, P = view.earlier
        half = cone_halfwidth(float(P[2, 2]), self._probability)
        place(self.ellipse, outline(x, P[:2, :2], self._probability))
        place(self.cone, closed(sector(x, half, CONE * unit)))

    def handles(self) -> Iterator[Artist]:
        """What the legend shows of it."""
        yield self.ellipse
