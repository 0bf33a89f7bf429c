"""What was believed before the step that a view shows: thin outlines, in grey."""

from collections.abc import Iterator

from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ekfsim.views.picture.artists import CONE, NOWHERE, closed, line, place, sector
from ekfsim.views.picture.belief.shape import Region

GHOST = "#7A7A7A"


class GhostArtists:
    """Ellipse and cone as they were: of the prior beside a revised estimate, of the last estimate
    beside a predicted one.
    """

    def __init__(self, axes: Axes) -> None:
        self.ellipse = line(axes, "ghost", "belief before", 3.15, GHOST, 0.9)
        self.cone = line(axes, "ghost-cone", "", 2.05, GHOST, 0.7)

    def show(self, before: Region | None, unit: float) -> None:
        """Move them. unit : m, what the robot's body measures in this Axes"""
        if before is None:
            place(self.ellipse, NOWHERE)
            place(self.cone, NOWHERE)
            return
        place(self.ellipse, before.rim)
        place(self.cone, closed(sector(before.pose, before.half, CONE * unit)))

    def handles(self) -> Iterator[Artist]:
        """What the legend shows of it."""
        yield self.ellipse
