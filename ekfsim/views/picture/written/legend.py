"""The legend of a view: what occurs in it, and nothing else. Its order never changes, and what
comes and goes with a reading stands last, so that nothing jumps.
"""

import math
from collections.abc import Iterable, Iterator, Sized
from functools import cache
from typing import Any, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerPathCollection, HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.transforms import Bbox

from ekfsim.views.picture.artists import empty
from ekfsim.views.picture.layout import COLUMN, ROW, Layout
from ekfsim.views.picture.written.lettering import drawable, wrapped
from ekfsim.views.picture.written.outlined import PER_POINT, OutlinedText
from ekfsim.views.picture.written.samples import Handle, Sample, first, sample, style

HANDLERS: dict[type, Any] = {
    tuple: HandlerTuple(ndivide=1),
    PathCollection: HandlerPathCollection(numpoints=5),
}
LETTERS = 30  # in a line
POINTS = 8.0  # the letters' size where there is room
FEWEST = 6.0  # points; smaller ones cannot be read
RIM = 3.0  # pixels about a row, which its lines are wide
UP = 0.1  # rows: by as much a row's ink begins above it
WIDE, APART = 2.4, 3.2  # heights of the letters: of a sample, and from its begin to its words


def entries(handles: Iterable[Handle]) -> tuple[list[Any], list[str]]:
    """Those of the handles that are seen now, and the words of each: what `legend` of an Axes
    takes, with `handler_map=HANDLERS`.
    """
    shown = [handle for handle in handles if _seen(handle)]
    words = [_words(str(first(handle).get_label())) for handle in shown]
    # matplotlib leaves out what begins with _, as the name of a file may
    return shown, [f" {word}" if word.startswith("_") else word for word in words]


class Row:
    """An entry: a sample, and words beside it."""

    def __init__(self, figure: Figure, handle: Handle, words: str, points: float) -> None:
        self._em, self.lines = points / 72, 1 + words.count("\n")
        self._sample: list[Sample] = sample(handle)
        self.corner = self._drawn_at = (0.0, 0.0)  # left and top, in inches
        inches = figure.dpi_scale_trans
        self.text = OutlinedText(0, 0, points, inches, inches, "legend-text")
        self.text.set_text(words)
        longest = np.asarray(self.text.get_path().vertices)[:, 0].max(initial=0.0)
        self.width = APART * self._em + points * PER_POINT * float(longest)
        for artist in (*self._sample, self.text):
            artist.set_figure(figure)
        for artist in self._sample:
            artist.set_transform(inches)

    def place(self, left: float, top: float) -> None:
        """Begin it at a corner, in inches. It goes there when it is drawn."""
        self.corner = left, top

    def artists(self) -> Iterator[Artist]:
        """All of it, in its place."""
        if self.corner != self._drawn_at:
            self._drawn_at, (left, top) = self.corner, self.corner
            em, baseline = self._em, top - self._em
            for artist in self._sample:
                artist.fill(Bbox.from_bounds(left, baseline - 0.02 * em, WIDE * em, 0.7 * em))
            self.text.place(left + APART * em, baseline)
        yield from self._sample
        yield self.text

    def draw(self, renderer: Any) -> None:
        """Draw all of it."""
        for artist in self.artists():
            artist.draw(renderer)


class Key(Artist):
    """The legend of a figure. Each of its rows is made when it is first needed."""

    def __init__(self, figure: Figure) -> None:
        super().__init__()
        self.set(zorder=5, gid="legend")
        self._layout: Layout | None = None
        self._made: dict[object, Row] = {}
        self._rows: list[Row] = []
        self.look: tuple[object, ...] = ()  # what tells each row from others
        self._pitch = ROW
        figure.add_artist(self)
        self._figure = figure

    def arrange(self, layout: Layout) -> None:
        """Where it stands from now on."""
        self._layout, self.look = layout, ()

    def show_entries(self, handles: Iterable[Handle]) -> None:
        """Show what is seen now."""
        handles, words = entries(handles)
        look = tuple(zip(words, map(style, handles), strict=True))
        if look == self.look:
            return
        layout = self._layout
        assert layout is not None
        room = layout.room / ROW * layout.columns  # rows of letters of the usual size
        points = max(POINTS * min(1.0, room / max(len(words), 1)), FEWEST)
        self.look, self._rows = look, []
        for entry, handle in zip(look, handles, strict=True):
            if (entry, points) not in self._made:
                self._made[entry, points] = Row(self._figure, handle, entry[0], points)
            self._rows.append(self._made[entry, points])
        self._pitch = ROW * points / POINTS
        self._place(layout)

    def draw(self, renderer: Any) -> None:
        """Draw all of it."""
        if self.get_visible():
            for row in self._rows:
                row.draw(renderer)
        self.stale = False

    def rows(self) -> list[Row]:
        """Its entries: the same one looks the same at the same corner, whatever else is shown."""
        return self._rows

    def box(self, row: Row) -> Bbox:
        """The box, in pixels, that nothing else of it is drawn in."""
        dpi, (left, top) = self._figure.dpi, row.corner
        above = top + UP * self._pitch
        return Bbox.from_extents(
            left * dpi - RIM,
            (above - row.lines * self._pitch) * dpi,
            (left + row.width) * dpi + RIM,
            above * dpi,
        )

    def get_window_extent(self, renderer: Any = None) -> Bbox:
        """Where it is, in pixels."""
        parts = [
            artist.get_window_extent(renderer) for row in self._rows for artist in row.artists()
        ]
        return Bbox.union(parts) if parts else Bbox.null()

    def get_texts(self) -> list[OutlinedText]:
        """The words of its entries."""
        return [row.text for row in self._rows]

    def _place(self, layout: Layout) -> None:
        left, top = layout.legend
        tall = math.ceil(len(self._rows) / layout.columns)
        for number, row in enumerate(self._rows):
            column, place = divmod(number, tall)
            if place == 0:
                below = top
            row.place(left + column * COLUMN, below)
            below -= row.lines * self._pitch


@cache
def _words(label: str) -> str:
    return drawable("\n".join(wrapped([label], LETTERS, 3)))


def _seen(handle: Handle) -> bool:
    """Whether there is something of it in the picture. A line of one point is none; an area is
    named while it is drawn in the style of a warning, too.
    """
    if isinstance(handle, tuple):
        return not all(map(empty, handle))
    if isinstance(handle, Line2D) and handle.get_linestyle() != "None":
        return len(cast(Sized, handle.get_xdata(orig=True))) > 1
    return isinstance(handle, Polygon) or not empty(handle)
