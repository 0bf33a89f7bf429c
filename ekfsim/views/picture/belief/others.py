"""What is drawn in one Axes of a filter that watches beside the first:
its path, its estimate, its ellipse.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ekfsim.geometry.ellipse import outline
from ekfsim.views.picture.artists import NOSE, NOWHERE, direction, line, marks, place
from ekfsim.views.picture.belief.shape import NO_POSE
from ekfsim.views.picture.belief.warned import ALARM, ALARM_DASHES
from ekfsim.views.playback.view import View
from ekfsim.views.words.judgement import standing

BAND = 4.0  # points, of a warning


class Style(NamedTuple):
    """How the artists of one of them are told from the others, without colour too."""

    color: str
    marker: str
    dashes: tuple[int, tuple[float, ...]]


STYLES = (
    Style("#8C510A", "s", (0, (5, 1.5))),
    Style("#6A3D9A", "v", (0, (2, 1))),
    Style("#C51B7D", "P", (0, (6, 1.5, 1.5, 1.5))),
    Style("#6B6B00", "h", (0, (1, 1))),
)


class OtherArtists:
    """One filter that watches beside the first."""

    def __init__(self, axes: Axes, name: str, number: int, probability: float) -> None:
        """number : of this filter among those beside the first, from 0"""
        self._probability, self._name = probability, name
        color, marker, dashes = STYLES[number % len(STYLES)]
        z = 3.05 + 0.01 * number
        self.path = line(axes, f"path-{name}", "", z, color, 1.0, dashes)
        self.ellipse = line(axes, f"ellipse-{name}", "", z, color, 1.6, dashes)
        # beneath it, which stays to tell whose ellipse it is
        self.warning = line(
            axes, f"ellipse-{name}-outside", "", z - 0.005, ALARM, BAND, ALARM_DASHES
        )
        self.heading = line(axes, f"heading-{name}", "", 4.3, color, 1.6)
        self.reference = marks(axes, f"reference-{name}", "", 4.4, color, marker, 6.5)
        self.reference.set(markerfacecolor="white", markeredgewidth=1.4)

    def show(self, view: View, unit: float) -> None:
        """Move everything to what this filter believes.
        unit : m, what the robot's body measures in this Axes
        """
        x, P = view.pose
        x = NO_POSE if view.unplaced else x
        place(self.path, view.path())
        rim = outline(x, P[:2, :2], self._probability)
        place(self.ellipse, rim)
        outside = standing(view, self._probability).outside_ellipse
        place(self.warning, rim if outside else NOWHERE)
        place(self.heading, np.stack([x[:2], x[:2] + NOSE * unit * direction(x[2])]))
        place(self.reference, x[None, :2])

    def handles(self) -> Iterator[tuple[Artist, ...]]:
        """What the legend shows of it."""
        self.ellipse.set_label(f"{self._name}: estimate, ellipse, path")
        yield self.ellipse, self.reference
