"""The legend of a view: what occurs in it, and nothing else. Its order never changes, and what
comes and goes with a reading stands last, so that nothing jumps.
"""

from collections.abc import Iterable, Sized
from typing import Any, cast

from matplotlib.artist import Artist
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.legend_handler import HandlerPathCollection, HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from ekfsim.views.picture.artists import empty
from ekfsim.views.picture.layout import ROW, Layout
from ekfsim.views.picture.lettering import drawable, families, wrapped

Handle = Artist | tuple[Artist, ...]  # those of a tuple are drawn on top of each other
HANDLERS: dict[type, Any] = {
    tuple: HandlerTuple(ndivide=1),
    PathCollection: HandlerPathCollection(numpoints=5),
}
LETTERS = 30  # in a line
POINTS = 8.0  # the letters' size where there is room
FEWEST = 6.0  # points; smaller ones cannot be read


def entries(handles: Iterable[Handle]) -> tuple[list[Any], list[str]]:
    """Those of the handles that are seen now, and the words of each: what `legend` of an Axes
    takes, with `handler_map=HANDLERS`.
    """
    shown = [handle for handle in handles if _seen(handle)]
    labels = [str(_first(handle).get_label()) for handle in shown]
    words = [drawable("\n".join(wrapped([label], LETTERS, 3))) for label in labels]
    # matplotlib leaves out what begins with _, as the name of a file may
    return shown, [f" {word}" if word.startswith("_") else word for word in words]


class Legends:
    """The legends of a figure, of which one is shown; each is made when it is first needed."""

    shown: Legend

    def __init__(self, figure: Figure) -> None:
        self._figure = figure
        self._layout: Layout | None = None
        self._made: dict[object, Legend] = {}

    def arrange(self, layout: Layout) -> None:
        """Where they stand from now on."""
        for legend in self._made.values():
            legend.remove()
        self._made, self._layout = {}, layout

    def show(self, handles: Iterable[Handle]) -> None:
        """Show what is seen now."""
        handles, words = entries(handles)
        look = tuple(zip(words, map(_style, handles), strict=True))
        for legend in self._made.values():
            legend.set_visible(False)
        if look not in self._made:
            self._made[look] = self._make(handles, words)
        self.shown = self._made[look]
        self.shown.set_visible(True)

    def _make(self, handles: list[Any], words: list[str]) -> Legend:
        layout = self._layout
        assert layout is not None
        left, top = layout.legend
        room = layout.room / ROW * layout.columns  # rows of letters of the usual size
        points = max(POINTS * min(1.0, room / max(len(words), 1)), FEWEST)
        legend = self._figure.legend(
            handles, words, loc="upper left", ncols=layout.columns,
            bbox_to_anchor=(left / layout.width, top / layout.height), borderaxespad=0.0,
            borderpad=0.0, fontsize=points, labelspacing=0.4, handlelength=2.4, frameon=False,
            handler_map=HANDLERS,
        )  # fmt: skip
        for text in legend.get_texts():
            text.set(family=families(), parse_math=False)
        return legend


def _first(handle: Handle) -> Artist:
    return handle[0] if isinstance(handle, tuple) else handle


def _seen(handle: Handle) -> bool:
    """Whether there is something of it in the picture. A line of one point is none; an area is
    named while it is drawn in the style of a warning, too.
    """
    if isinstance(handle, tuple):
        return not all(map(empty, handle))
    if isinstance(handle, Line2D) and handle.get_linestyle() != "None":
        return len(cast(Sized, handle.get_xdata(orig=True))) > 1
    return isinstance(handle, Polygon) or not empty(handle)


def _style(handle: Handle) -> object:
    """What of an artist's style differs from view to view, and in the legend."""
    first = _first(handle)
    return (
        tuple(map(_style, handle))
        if isinstance(handle, tuple)
        else (
            (
                first.get_linestyle(),
                first.get_linewidth(),
                first.get_marker(),
                first.get_markersize(),
            )
            if isinstance(first, Line2D)
            else ()
        )
    )
