"""The ellipses of a belief that is several Gaussians, as bold as each is heavy, with its weight."""

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patheffects import withStroke
from matplotlib.text import Text

from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import outline
from ekfsim.views.picture.artists import CROWD

FAINTEST = 0.35  # opacity of a hypothesis of no weight
LABELLED = 0.01  # a weight below it is drawn and not written
LABELS = 8
POINTS = 7.0
WIDTH, HEIGHT = 2.8, 1.4  # of a label, in heights of its letters
SIDES = np.array([[0, 1], [0, -1], [1, 0], [-1, 0], [1, 1], [-1, 1], [1, -1], [-1, -1]])


class HypothesisArtists:
    """An ellipse for each hypothesis, where there are several."""

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self.ellipses = LineCollection(
            [], linewidths=1.4, zorder=3.05, label="hypotheses, by weight", gid="hypotheses"
        )
        axes.add_collection(self.ellipses, autolim=False)
        self.labels = [_label(axes) for _ in range(LABELS)]

    def show(self, parts: list[tuple[float, Gaussian]], probability: float) -> None:
        """Draw them anew; parts : the lightest first. A weight that has no place of its own beside
        heavier ones is not written here.
        """
        heaviest = parts[::-1]  # first, so that the legend shows its colour
        rims = [outline(x[:2], P[:2, :2], probability) for _, (x, P) in heaviest]
        if rims or self.ellipses.get_paths():
            self.ellipses.set_segments(rims)
            self.ellipses.set_color(
                [to_rgba(CROWD, FAINTEST + (1 - FAINTEST) * w) for w, _ in heaviest]
            )
        told = [(w, rim) for (w, _), rim in zip(heaviest, rims, strict=True) if w >= LABELLED]
        told = told[:LABELS]
        places = dict(self._places([rim for _, rim in told]))
        for i, label in enumerate(self.labels):
            label.set_visible(i in places)
            if i in places:
                label.set_position(places[i])
                label.set_text(f"{told[i][0]:.2f}")

    def _places(self, rims: list[Array]) -> Iterator[tuple[int, tuple[float, float]]]:
        """Where labels are centred that do not cover each other, in m."""
        to_pixels = self._axes.transData
        em = POINTS / 72 * self._axes.figure.dpi
        half = np.array([WIDTH, HEIGHT]) * em / 2
        taken: list[Array] = []
        for i, rim in enumerate(rims):
            drawn = to_pixels.transform(rim)
            low, high = drawn.min(axis=0), drawn.max(axis=0)
            for side in SIDES:
                centre = (low + high) / 2 + side * ((high - low) / 2 + half)
                if all((np.abs(centre - other) >= 2 * half).any() for other in taken):
                    taken.append(centre)
                    x, y = to_pixels.inverted().transform(centre).tolist()
                    yield i, (x, y)
                    break


def _label(axes: Axes) -> Text:
    label = axes.text(
        0, 0, "", fontsize=POINTS, color=CROWD, ha="center", va="center", zorder=7, clip_on=True
    )
    label.set_path_effects([withStroke(linewidth=2, foreground="white")])
    label.set_gid("hypothesis-weight")
    label.set_visible(False)
    return label
