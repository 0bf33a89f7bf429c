"""The plot of a run: all panels, what they mean, and the verdict on each filter."""

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ekfsim.errors import UsageError
from ekfsim.models.protocols import Quantity
from ekfsim.provenance import told_in_a_line
from ekfsim.scene import Scene
from ekfsim.views.curves.bands import ErrorPanel, InnovationPanel
from ekfsim.views.curves.judged import BOUND, DRAWN, NeesPanel, NisPanel
from ekfsim.views.curves.marks import (
    mark_impossible,
    mark_lost,
    mark_moments,
    mark_readings,
    occurring,
)
from ekfsim.views.curves.pens import pen
from ekfsim.views.curves.series import Series
from ekfsim.views.curves.thinning import ENOUGH, is_long
from ekfsim.views.film.still import save
from ekfsim.views.picture.lettering import drawable, families, shortened, wrapped
from ekfsim.views.words.captions import source
from ekfsim.views.words.closing import sentence

MOST = 4  # quantities that are read of which the innovations have a panel
INCHES, DPI = (10.0, 9.0), 100
LETTERS, TITLE_LETTERS, FOOT_LETTERS = 13, 10, 21  # to an inch
VERDICT_LINES, FOOT_LINES, FOOT = 2, 2, 0.24  # the last in inches
WORD = 1.9  # in, of an entry of the legend
GREY = "#666666"
Place = Literal["outside upper left", "outside lower left"]
Panel = ErrorPanel | InnovationPanel | NisPanel | NeesPanel


def panels_of(runs: Sequence[Series]) -> list[Panel]:
    """What there is to draw: errors, NIS and NEES; without a truth innovations and NIS."""
    if any(run.has_truth for run in runs):
        nis = [NisPanel()] if any(run.read.any() for run in runs) else []
        return [*(ErrorPanel(entry) for entry in range(3)), *nis, NeesPanel()]
    return [*map(InnovationPanel, quantities(runs)[:MOST]), NisPanel()]


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
    x = runs[0].abscissa
    for own in axes:
        own.set_xlim(x[0], x[-1] if x[-1] > x[0] else x[0] + 1)
        own.tick_params(labelbottom=own is axes[-1])
    axes[-1].set_xlabel("t (s)" if runs[0].clocked else "step")
    if not runs[0].clocked:
        axes[-1].xaxis.set_major_locator(MaxNLocator("auto", integer=True, steps=[1, 2, 5, 10]))
    mark_moments(axes, runs[0])
    mark_lost(axes, runs, [run.name for run in runs])


def marked(runs: Sequence[Series]) -> tuple[list[Artist], list[str]]:
    """What else is drawn, and what it is."""
    truth = any(run.has_truth for run in runs)
    band = Patch(color=pen(0).colour if len(runs) == 1 else GREY, alpha=0.25, lw=0)
    handles: list[Artist] = [band]
    words = ["±2σ: 19 of 20 lie inside" if truth else "±2√S: 19 of 20 lie inside"]
    for probability, dashes in DRAWN.items():
        handles.append(Line2D([], [], color=BOUND, lw=0.9, ls=dashes))
        words.append(f"χ² {100 * probability:g} %")
    for handle, word in occurring(runs):
        handles.append(handle)
        words.append(word)
    return handles, words


def figure_of(
    runs: Sequence[Series], title: str = "", made_by: str = "",
    inches: tuple[float, float] = INCHES, dpi: float = DPI,
) -> Figure:  # fmt: skip
    """The whole plot: title and verdicts, panels, legend, what made it."""
    panels, (width, height) = panels_of(runs), inches
    figure = Figure(figsize=inches, dpi=dpi, layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    told = "; ".join(filter(None, [*remarks(runs), made_by]))
    foot = wrapped([drawable(told)], int(FOOT_LETTERS * width), FOOT_LINES)
    engine = figure.get_layout_engine()
    assert isinstance(engine, ConstrainedLayoutEngine)
    engine.set(rect=(0, FOOT / height, 1, 1 - FOOT / height), h_pad=0.03)
    figure.text(
        0.995, 0.004, "\n".join(foot), fontsize=5.5, ha="right", va="bottom", color=GREY,
        parse_math=False, family=families(), gid="source",
    )  # fmt: skip
    grid = figure.subplots(
        len(panels), 1, squeeze=False, sharex=True,
        height_ratios=[panel.height for panel in panels],
    )  # fmt: skip
    axes = list(grid[:, 0])
    draw_panels(panels, axes, runs)
    figure.align_ylabels(axes)
    letters = int(LETTERS * width)
    verdicts = ["\n".join(wrapped([verdict(run)], letters, VERDICT_LINES)) for run in runs]
    lines: list[Artist] = [
        Line2D([], [], color=pen(n).colour, ls=pen(n).dashes, lw=pen(n).width)
        for n in range(len(runs))
    ]
    head = _legend(figure, "outside upper left", lines, verdicts, 9, 1)
    if title:
        head.set_title(shortened(title, int(TITLE_LETTERS * width)), FontProperties(size=12))
    head.set_alignment("left")
    _legend(figure, "outside lower left", *marked(runs), 8, max(int(width / WORD), 1))
    return figure


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


def write(
    runs: Sequence[Series],
    scene: Scene,
    target: Path,
    size: tuple[int, int] | None = None,
    dpi: int = DPI,
    force: bool = False,
) -> None:
    """Write the plot of a scene's filters into a file. size : its pixels, at so many to an inch

    Raises UsageError where it is no place for a picture, or the size leaves no room.
    """
    inches = INCHES if size is None else (size[0] / dpi, size[1] / dpi)
    title, made_by = _title(scene), told_in_a_line(scene)
    figure = figure_of(runs, title, made_by, inches, dpi)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message="constrained_layout not applied")
        try:
            save(figure, target, title, made_by, force)
        except UserWarning:
            raise UsageError(
                f"there is no room for {len(figure.axes)} panels in {inches[0]:.3g} by "
                f"{inches[1]:.3g} inches; choose a larger --size, or a smaller --dpi"
            ) from None


def _title(scene: Scene) -> str:
    """The name of its commands, and what is drawn of them."""
    return f"{Path(scene.commands_source).stem}: {source(scene)}"


def verdict(run: Series) -> str:
    """What is to be said of a filter when its run is over."""
    return f"{run.name}: {sentence(run.evidence)}" if run.name else sentence(run.evidence)


def _legend(
    figure: Figure,
    place: Place,
    handles: list[Artist],
    words: list[str],
    points: float,
    columns: int,
) -> Legend:
    # matplotlib leaves out what begins with _, as the name of a file may
    told = [f" {word}" if word.startswith("_") else word for word in map(drawable, words)]
    made = figure.legend(
        handles,
        told,
        loc=place,
        ncols=columns,
        fontsize=points,
        frameon=False,
        borderpad=0.1,
        borderaxespad=0.2,
    )
    for word in (*made.get_texts(), made.get_title()):
        word.set(family=families(), parse_math=False)
    return made
