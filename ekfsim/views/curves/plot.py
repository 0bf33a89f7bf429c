"""The plot of a run: all panels, what they mean, and the verdict on each filter."""

import warnings
from collections.abc import Sequence, Sized
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
from ekfsim.views.curves.panels import Panel, draw_panels, panels_of, remarks
from ekfsim.views.curves.pens import pen
from ekfsim.views.curves.series import Series
from ekfsim.views.film.still import save
from ekfsim.views.picture.look import SCREEN, STANDARD, Paper
from ekfsim.views.picture.written.lettering import drawable, families, shortened, wrapped
from ekfsim.views.words.captions import percent, source
from ekfsim.views.words.verdict import sentence

WIDTH = 10.0  # in
AROUND, VERDICT, UNIT = 1.5, 0.3, 1.3  # in: above and below, for each filter, for a panel of 1
LETTERS, TITLE_LETTERS, FOOT_LETTERS = 13, 10, 21  # to an inch
VERDICT_LINES, FOOT_LINES = 2, 2
FOOT_LINE, EDGE = 0.11, 0.03  # in
POINTS = 72  # to an inch
ROUNDING = 1e-6  # px: a canvas has no part of a pixel, and a quotient may fall short of one
WORD = 1.9  # in, of an entry of the legend
GREY = "#666666"
Place = Literal["outside upper left", "outside lower left"]


def lines(runs: Sequence[Series]) -> list[Artist]:
    """A line as each filter's lines are drawn."""
    pens = map(pen, range(len(runs)))
    return [Line2D([], [], color=own.colour, ls=own.dashes, lw=own.width) for own in pens]


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
    paper: Paper = SCREEN, probability: float = STANDARD.probability,
) -> Figure:  # fmt: skip
    """The whole plot: title and verdicts, panels, legend, what made it."""
    panels = panels_of(runs, probability)
    width, height = inches = _inches(paper, panels, len(runs))
    figure = Figure(figsize=inches, dpi=paper.dpi, layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    told = "; ".join(filter(None, [*remarks(runs), made_by]))
    foot = wrapped([drawable(told)], int(FOOT_LETTERS * width), FOOT_LINES)
    engine = figure.get_layout_engine()
    assert isinstance(engine, ConstrainedLayoutEngine)
    away = (0.5 + len(foot)) * FOOT_LINE
    if away >= height:
        raise _no_room(panels, width, height)
    engine.set(rect=(0, away / height, 1, 1 - away / height), h_pad=0.03)
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
    head = _legend(figure, "outside upper left", EDGE, lines(runs), verdicts, 9)
    if title:
        head.set_title(
            drawable(shortened(title, int(TITLE_LETTERS * width))),
            FontProperties(family=families(), size=12),
        )
    head.set_alignment("left")
    columns = max(int(width / WORD), 1)
    _legend(figure, "outside lower left", away, *marked(runs, probability), 8, columns)
    return figure


def write(
    runs: Sequence[Series],
    scene: Scene,
    target: Path,
    paper: Paper = SCREEN,
    probability: float = STANDARD.probability,
    force: bool = False,
) -> None:
    """Write the plot of a scene's filters into a file. probability : of the bands

    Raises UsageError where it is no place for a picture, or the paper leaves no room.
    """
    title, made_by = _title(scene), told_in_a_line(scene)
    figure = figure_of(runs, title, made_by, paper, probability)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message="constrained_layout not applied")
        try:
            save(figure, target, title, made_by, force)
        except UserWarning:
            raise _no_room(figure.axes, *figure.get_size_inches()) from None


def _no_room(panels: Sized, width: float, height: float) -> UsageError:
    """What is to be raised where the letters leave none for the curves."""
    return UsageError(
        f"there is no room for {len(panels)} panels in {width:.3g} by "
        f"{height:.3g} inches; choose a larger --size, or a smaller --dpi"
    )


def _inches(paper: Paper, panels: Sequence[Panel], filters: int) -> tuple[float, float]:
    """Width and height: those of the paper, or as high as what is drawn asks for."""
    if paper.size is None:
        return WIDTH, AROUND + VERDICT * filters + UNIT * sum(panel.height for panel in panels)
    width, height = paper.size
    return (width + ROUNDING) / paper.dpi, (height + ROUNDING) / paper.dpi


def _title(scene: Scene) -> str:
    """The name of its commands, and what is drawn of them."""
    return f"{Path(scene.commands_source).stem}: {source(scene)}"


def verdict(run: Series) -> str:
    """What is to be said of a filter when its run is over."""
    told, found = sentence(run.evidence), run.whitened.found()
    if found.word != "no evidence":
        told += f"; innovations are {found.word} (p {float(found.p):.2g})"
    return f"{run.name}: {told}" if run.name else told


def _legend(
    figure: Figure,
    place: Place,
    away: float,
    handles: list[Artist],
    words: list[str],
    points: float,
    columns: int = 1,
) -> Legend:
    """A legend so many inches away from an edge of the figure."""
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
        borderaxespad=POINTS * away / points,
    )
    for word in (*made.get_texts(), made.get_title()):
        word.set(family=families(), parse_math=False)
    return made
