"""Where the robot truly was, and where it would be by odometry alone: faint, beneath the rest."""

from matplotlib.axes import Axes

from ekfsim.views.picture.artists import PURPLE, TRUTH, Dashes, line, place
from ekfsim.views.picture.belief.shape import Shape

FAINT = 0.6
TRUE_DASHES: Dashes = (0, (1.2, 1.6))
RECKONED_DASHES: Dashes = (0, (8, 2.5))


class WayArtists:
    """Both ways up to a view."""

    def __init__(self, axes: Axes) -> None:
        self.reckoned = line(
            axes, "reckoned-way", "way by odometry alone", 1.9, PURPLE, 1.1, RECKONED_DASHES
        )
        self.true = line(axes, "true-way", "true way", 1.95, TRUTH, 1.1, TRUE_DASHES)
        for way in (self.reckoned, self.true):
            way.set_alpha(FAINT)

    def show(self, shape: Shape) -> None:
        """Move them to a view."""
        place(self.reckoned, shape.reckoned)
        place(self.true, shape.true)
