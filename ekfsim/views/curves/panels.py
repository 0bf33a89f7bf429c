"""Which panels a run has, and what all of them share: the axis of the steps, and the marks."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ekfsim.errors import UsageError
from ekfsim.geometry.ellipse import cone_factor
from ekfsim.models.protocols import Quantity
from ekfsim.views.curves.bands import ErrorPanel, InnovationPanel, NoisePanel
from ekfsim.views.curves.judged import NeesPanel, NisPanel
from ekfsim.views.curves.marks import mark_impossible, mark_lost, mark_moments, mark_readings
from ekfsim.views.curves.series import Series
from ekfsim.views.curves.thinning import ENOUGH, is_long
from ekfsim.views.picture.look import STANDARD

MOST = 4  # quantities that are read of which the innovations have a panel
Panel = ErrorPanel | InnovationPanel | NoisePanel | NisPanel | NeesPanel


def panels_of(runs: Sequence[Series], probability: float = STANDARD.probability) -> list[Panel]:
    """What there is to draw: errors, NIS and NEES; without a truth innovations and NIS. Before NIS
    what a filter that learns its sensors' noises has learnt.
    probability : of the bands

    Raises UsageError where there is nothing.
    """
    reach = cone_factor(probability)
    learnt = [NoisePanel()] if any(run.learnt for run in runs) else []
    if any(run.has_truth for run in runs):
        nis = [NisPanel()] if any(run.read.any() for run in runs) else []
        return [*(ErrorPanel(entry, reach) for entry in range(3)), *learnt, *nis, NeesPanel()]
    if not any(run.read.any() for run in runs):
        raise UsageError("there is nothing to plot: no truth is known, and nothing was read")
    return [*(InnovationPanel(q, reach) for q in quantities(runs)[:MOST]), *learnt, NisPanel()]


def quantities(runs: Sequence[Series]) -> list[Quantity]:
    """All that was read, in the order of the first readings."""
    return list(dict.fromkeys(quantity for run in runs for quantity in run.innovations))


def draw_panels(panels: Sequence[Panel], axes: Sequence[Axes], runs: Sequence[Series]) -> None:
    """Draw each panel on its Axes, and mark what happened."""
    for panel, own in zip(panels, axes, strict=True):
        panel.draw(own, runs)
        if isinstance(panel, NisPanel):
            mark_readings(own, runs)
        elif isinstance(panel, NeesPanel):
            mark_impossible(own, runs)
        over_steps(own, runs[0], own is axes[-1])
    mark_moments(axes, runs[0])
    mark_lost(axes, runs)


def over_steps(axes: Axes, run: Series, last: bool) -> None:
    """An axis that counts steps or seconds. last : whether it is the lowest of a column"""
    x = run.abscissa
    axes.set_xlim(x[0], x[-1] if x[-1] > x[0] else x[0] + 1)
    if not run.clocked:
        axes.xaxis.set_major_locator(MaxNLocator("auto", integer=True, steps=[1, 2, 5, 10]))
    axes.tick_params(labelbottom=last)
    if last:
        axes.set_xlabel("t (s)" if run.clocked else "step")


def remarks(runs: Sequence[Series]) -> list[str]:
    """What is not drawn, and why."""
    told = []
    if not any(run.has_truth for run in runs):
        told.append("no truth is known: innovations and NIS alone")
        if left_out := quantities(runs)[MOST:]:
            told.append(f"left out: innovations of {', '.join(q.name for q in left_out)}")
    if is_long(len(runs[0])):
        told.append(
            f"{len(runs[0])} steps are drawn as {ENOUGH} stretches, each by its least and its "
            "greatest value"
        )
    return told
