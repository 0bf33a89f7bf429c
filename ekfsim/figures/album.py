"""A folder of figures and tables with one page of captions:
what to see, and how it compares with the print.
"""

import csv
import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ekfsim.views.film.still import metadata
from ekfsim.views.picture.panels import in_metres
from ekfsim.views.picture.written.lettering import drawable

PATTERNS = ("*.png", "*.svg", "*.pdf", "*.csv", "captions.md")  # what an album consists of
BLUE, SKY, GREEN, VERMILLION, PURPLE, ORANGE = (
    "#0072B2",
    "#56B4E9",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#E69F00",
)
GREY, BLACK = "#777777", "#000000"
# the minus of a number as it is printed, which no program reads
NEGATIVE = re.compile(r"^−(?=[\d.]+$)")
DPI = 120
SOURCE_LINE = 0.14  # in, at the foot of a figure
SOURCE_LETTERS = 21  # of it, to an inch


@dataclass
class Album:
    """Collects the figures and tables of one document, and writes them."""

    title: str
    source: str  # which scene, log, seed, filter and version made it
    folder: Path
    formats: Sequence[str] = ("png",)
    pages: list[str] = field(default_factory=list)

    def figure(self, width: float = 7.5, height: float = 5.0) -> Figure:
        """A new figure, in inches, that no window manages."""
        made = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
        FigureCanvasAgg(made)
        return made

    def add(
        self, figure: Figure, name: str, title: str, caption: str, source: str | None = None
    ) -> None:
        """Write a figure in every format, and its caption.
        name : as in "fig4-paths", without an ending

        source : what made it, where that is not what made the others
        """
        width, height = figure.get_size_inches()
        made_by = textwrap.wrap(drawable(source or self.source), int(SOURCE_LETTERS * width))
        engine = figure.get_layout_engine()
        if isinstance(engine, ConstrainedLayoutEngine):
            foot = SOURCE_LINE * len(made_by) / height
            engine.set(rect=(0, foot, 1, 1 - foot))
        figure.text(
            0.995, 0.004, "\n".join(made_by), fontsize=5.5, ha="right", va="bottom", color="#777777"
        )
        for ending in self.formats:
            notes = metadata(ending, title, source or self.source)
            figure.savefig(self.folder / f"{name}.{ending}", dpi=DPI, metadata=notes)
        self.pages.append(
            f"## {title}\n\n![{title}]({name}.{self.formats[0]})\n\n{filled(caption)}\n"
        )

    def table(
        self,
        name: str,
        title: str,
        header: Sequence[str],
        rows: Sequence[Sequence[str]],
        caption: str,
    ) -> None:
        """Write a table into the captions, and as CSV with a last column that says what made it."""
        with (self.folder / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
            plain = [[*(NEGATIVE.sub("-", cell) for cell in row), self.source] for row in rows]
            csv.writer(file, lineterminator="\n").writerows([[*header, "made by"], *plain])
        lines = [
            "| " + " | ".join(cells) + " |" for cells in (header, ["---"] * len(header), *rows)
        ]
        self.pages.append(f"## {title}\n\n" + "\n".join(lines) + f"\n\n{filled(caption)}\n")

    def note(self, title: str, text: str) -> None:
        """Say in the captions why something is not drawn."""
        self.pages.append(f"## {title}\n\n{text.strip()}\n")

    def close(self) -> None:
        """Write the page of captions."""
        text = "\n".join([f"# {self.title}\n", f"{self.source}\n", *self.pages])
        (self.folder / "captions.md").write_text(text, encoding="utf-8")


def filled(text: str) -> str:
    """Paragraphs of even lines; lists and tables stay as they are."""
    paragraphs = text.strip().split("\n\n")
    return "\n\n".join(
        paragraph if any(line.startswith(("- ", "| ", "* ")) for line in paragraph.splitlines()[1:])
        else textwrap.fill(" ".join(paragraph.split()), 120, break_long_words=False,
        break_on_hyphens=False)
        for paragraph in paragraphs
    )  # fmt: skip


def labelled(axes: Axes, x: str, y: str) -> Axes:
    """Axes with their quantities and units, and a light grid."""
    axes.set(xlabel=x, ylabel=y)
    axes.grid(True, color="#DDDDDD", lw=0.6)
    axes.set_axisbelow(True)
    return axes


def square(axes: Axes) -> Axes:
    """Axes of a map: metres alike in both directions."""
    axes.set_aspect("equal", adjustable="datalim")
    labelled(axes, "x (m)", "y (m)")
    in_metres(axes)
    return axes
