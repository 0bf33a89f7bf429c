"""The ellipses of a belief that is several Gaussians, as bold as each is heavy, with its weight."""

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.text import Text

from ekfsim.filters.belief import Gaussian
from ekfsim.geometry.ellipse import outline
from ekfsim.views.picture.artists import CROWD

FAINTEST = 0.25  # opacity of a hypothesis of no weight
LABELLED = 0.01  # a weight below it is drawn and not written
LABELS = 8
POINTS = 7.0


class HypothesisArtists:
    """An ellipse for each hypothesis, where there are several."""

    def __init__(self, axes: Axes) -> None:
        self.ellipses = LineCollection(
            [], linewidths=1.4, zorder=3.05, label="hypotheses, by weight", gid="hypotheses"
        )
        axes.add_collection(self.ellipses, autolim=False)
        self.labels = [_label(axes) for _ in range(LABELS)]

    def show(self, parts: list[tuple[float, Gaussian]], probability: float) -> None:
        """Draw them anew, the lightest first."""
        rims = [outline(x[:2], P[:2, :2], probability) for _, (x, P) in parts]
        if rims or self.ellipses.get_paths():
            self.ellipses.set_segments(rims)
            self.ellipses.set_color(
                [to_rgba(CROWD, FAINTEST + (1 - FAINTEST) * w) for w, _ in parts]
            )
        told = [(w, rim) for (w, _), rim in zip(parts, rims, strict=True) if w >= LABELLED]
        for i, label in enumerate(self.labels):
            label.set_visible(i < len(told))
            if i < len(told):
                w, rim = told[-1 - i]
                top = rim[rim[:, 1].argmax()]
                label.set_position((float(top[0]), float(top[1])))
                label.set_text(f"{w:.2f}")


def _label(axes: Axes) -> Text:
    label = axes.text(
        0, 0, "", fontsize=POINTS, color=CROWD, ha="center", va="bottom", zorder=7, clip_on=True
    )
    label.set_gid("hypothesis-weight")
    label.set_visible(False)
    return label
