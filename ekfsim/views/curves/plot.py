"""The plot of a run: all panels, what they mean, and the verdict on each filter."""

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ekfsim.errors import UsageError
from ekfsim.geometry.ellipse import cone_factor
from ekfsim.provenance import told_in_a_line
from ekfsim.scene import Scene
from ekfsim.views.curves.judged import BOUND, DRAWN
from ekfsim.views.curves.marks import occurring, tell_lost
from ekfsim.views.curves.panels import draw_panels, panels_of, remarks
from ekfsim.views.curves.pens import pen
from ekfsim.views.curves.series import Series
from ekfsim.views.film.still import save
from ekfsim.views.picture.lettering import drawable, families, shortened, wrapped
from ekfsim.views.picture.look import STANDARD
from ekfsim.views.words.captions import percent, source
from ekfsim.views.words.closing import sentence

INCHES, DPI = (10.0, 9.0), 100
LETTERS, TITLE_LETTERS, FOOT_LETTERS = 13, 10, 21  # to an inch
VERDICT_LINES, FOOT_LINES, FOOT = 2, 2, 0.24  # the last in inches
WORD = 1.9  # in, of an entry of the legend
GREY = "#666666"
Place = Literal["outside upper left", "outside lower left"]


def marked(runs: Sequence[Series], probability: float) -> tuple[list[Artist], list[str]]:
    """What else is drawn, and what it is."""
    truth = any(run.has_truth for run in runs)
    band = Patch(color=pen(0).colour if len(runs) == 1 else GREY, alpha=0.25, lw=0)
    handles: list[Artist] = [band]
    words = [f"±{cone_factor(probability):.3g}{'σ' if truth else '√S'} ({percent(probability)})"]
    for bound, dashes in DRAWN.items():
        handles.append(Line2D([], [], color=BOUND, lw=0.9, ls=dashes))
        words.append(f"χ² {percent(bound)}")
    for handle, word in occurring(runs):
        handles.append(handle)
        words.append(word)
    return handles, words


def figure_of(
    runs: Sequence[Series], title: str = "", made_by: str = "",
    inches: tuple[float, float] = INCHES, dpi: float = DPI,
    probability: float = STANDARD.probability,
) -> Figure:  # fmt: skip
    """The whole plot: title and verdicts, panels, legend, what made it."""
    panels, (width, height) = panels_of(runs, probability), inches
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
    tell_lost(axes[0], runs)
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
    _legend(figure, "outside lower left", *marked(runs, probability), 8, max(int(width / WORD), 1))
    return figure


def write(
    runs: Sequence[Series],
    scene: Scene,
    target: Path,
    size: tuple[int, int] | None = None,
    dpi: int = DPI,
    probability: float = STANDARD.probability,
    force: bool = False,
) -> None:
    """Write the plot of a scene's filters into a file. size : its pixels, at so many to an inch;
    probability : of the bands

    Raises UsageError where it is no place for a picture, or the size leaves no room.
    """
    inches = INCHES if size is None else (size[0] / dpi, size[1] / dpi)
    title, made_by = _title(scene), told_in_a_line(scene)
    figure = figure_of(runs, title, made_by, inches, dpi, probability)
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
