"""The plot of a run in a notebook: on a figure of its own, or on Axes of yours.

plot_errors(play(scene))
plot_errors({"ekf": play(scene), "ukf": play(scene.with_(filter="ukf"))}, axes)
"""

import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ekfsim.errors import UsageError
from ekfsim.records import Step
from ekfsim.views.curves.marks import tell_lost
from ekfsim.views.curves.panels import Panel, draw_panels, panels_of
from ekfsim.views.curves.plot import figure_of
from ekfsim.views.curves.series import Series
from ekfsim.views.playback.given import steps_in

GAP = 0.2  # of the height of a panel of errors, between two that share the place of one Axes


@dataclass(frozen=True)
class Curves:
    """What was drawn: a notebook shows it where it has a figure of its own."""

    figure: Figure
    axes: tuple[Axes, ...]  # errors of x, y, θ, NIS and NEES; or innovations and NIS
    series: tuple[Series, ...]  # the numbers, of each filter
    own: bool  # whether the figure was made for it

    def _repr_png_(self) -> bytes | None:
        if not self.own:
            return None
        file = io.BytesIO()
        self.figure.savefig(file, format="png")
        return file.getvalue()


def plot_errors(
    steps: Iterable[Step] | Mapping[str, Iterable[Step]],
    ax: Axes | Sequence[Axes] | None = None,
) -> Curves:
    """Plot errors with ±2σ, NIS and NEES over the steps of one filter, or of each by its name.
    ax : one Axes, whose place the panels share, or as many as they are; None: a new figure
    """
    named = steps if isinstance(steps, Mapping) else {"": steps}
    runs = tuple(Series.of(steps_in(own), name) for name, own in named.items())
    if not runs or not all(len(run) for run in runs):
        raise UsageError("there are no steps to plot; a generator gives its steps once")
    if len({len(run) for run in runs}) > 1:
        raise UsageError("the filters have not as many steps as each other: not the same run")
    panels = panels_of(runs)
    if ax is None:
        figure = figure_of(runs)
        return Curves(figure, tuple(figure.axes), runs, own=True)
    axes = _shared(ax, panels) if isinstance(ax, Axes) else list(ax)
    if len(axes) != len(panels):
        raise UsageError(f"there are {len(panels)} panels for {len(axes)} Axes; give one, or each")
    draw_panels(panels, axes, runs)
    tell_lost(axes[0], runs)
    theirs = axes[0].get_figure(root=True)
    assert theirs is not None
    return Curves(theirs, tuple(axes), runs, own=False)


def _shared(ax: Axes, panels: Sequence[Panel]) -> list[Axes]:
    """Axes for the panels, one beneath the other, in the place of one."""
    ax.set_axis_off()
    heights = np.array([panel.height for panel in panels])
    room = float(heights.sum() + GAP * (len(panels) - 1))
    bottoms = room - np.cumsum(heights) - GAP * np.arange(len(panels))
    return [
        ax.inset_axes((0.0, float(bottom) / room, 1.0, float(height) / room))
        for bottom, height in zip(bottoms, heights, strict=True)
    ]
