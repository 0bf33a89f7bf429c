"""Lines, patches and collections drawn again and again, as matplotlib draws them.

matplotlib asks an artist for its whole style each time, which takes longer than to draw it. Here
the style is asked for once, and again when it changes; what moves is asked for each time.
"""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path

# what draws a path, or the paths of a collection, through a matrix, in a style of its own
Stroke = Callable[[Any, Any], None]


class Recorder:
    """A renderer that remembers the strokes drawn with it."""

    def __init__(self, renderer: Any) -> None:
        self._renderer = renderer
        self.strokes: list[Stroke] = []

    def __getattr__(self, name: str) -> Any:
        """Whatever else a renderer can do."""
        return getattr(self._renderer, name)

    def draw_path(self, context: Any, path: Path, place: Any, face: Any = None) -> None:
        """Draw a path, and remember how."""

        def stroke(path: Any, place: Any) -> None:
            self._renderer.draw_path(context, path, place, face)

        self._draw(stroke, path, place)

    def draw_markers(
        self, context: Any, marker: Path, size: Any, path: Path, place: Any, face: Any = None
    ) -> None:
        """Draw a marker at each corner of a path, and remember how."""
        kept = size.frozen()

        def stroke(path: Any, place: Any) -> None:
            self._renderer.draw_markers(context, marker, kept, path, place, face)

        self._draw(stroke, path, place)

    def draw_path_collection(
        self, context: Any, place: Any, paths: list[Path], *style: Any, **more: Any
    ) -> None:
        """Draw many paths, and remember how. matplotlib asks with none what a renderer can do."""

        def stroke(paths: Any, place: Any) -> None:
            self._renderer.draw_path_collection(context, place, paths, *style, **more)

        if paths:
            self._draw(stroke, paths, place)

    def _draw(self, stroke: Stroke, path: Any, place: Any) -> None:
        self.strokes.append(stroke)
        stroke(path, place)


class Replay:
    """Draws artists on one canvas, with the strokes that each was drawn with the last time.

    Collections are taken to keep their style, path effects to move nothing (a rim does not), and
    all coordinate systems to be linear.
    """

    def __init__(self, canvas: Any) -> None:
        self._renderer = canvas.get_renderer()
        self._known: dict[Artist, tuple[object, list[Stroke]]] = {}

    def draw(self, artists: Iterable[Artist]) -> None:
        """Draw them in this order."""
        places: dict[int, Any] = {}  # the matrix of each coordinate system, as it is now
        for artist in artists:
            if not _repeatable(artist):
                artist.draw(self._renderer)
                continue
            style = _style(artist)
            known, strokes = self._known.get(artist, (None, []))
            if known != style or not strokes:
                recorder: Any = Recorder(self._renderer)
                artist.draw(recorder)
                self._known[artist] = style, recorder.strokes
                continue
            system = artist.get_transform()
            if id(system) not in places:
                places[id(system)] = system.get_affine().frozen()
            path, place = _path(artist), places[id(system)]
            for stroke in strokes:
                stroke(path, place)


def _repeatable(artist: Artist) -> bool:
    """Whether an artist's strokes follow all of its path, one after another."""
    match artist:
        case Line2D():
            return artist.get_markevery() is None
        case PolyCollection():  # a single one is drawn as a marker where it is small
            return len(artist.get_paths()) > 1
    return isinstance(artist, Patch | LineCollection)


def _style(artist: Artist) -> object:
    """What tells whether an artist is to be drawn as before."""
    if isinstance(artist, Patch):
        return (
            artist.get_facecolor(),
            artist.get_edgecolor(),
            artist.get_linestyle(),
            artist.get_linewidth(),
        )
    if not isinstance(artist, Line2D):
        return ()
    return (
        artist.get_linestyle(),
        artist.get_linewidth(),
        artist.get_marker(),
        artist.get_markersize(),
        artist.get_markerfacecolor(),
        artist.get_markeredgewidth(),
    )


def _path(artist: Artist) -> Any:
    """The path as it is now; of a collection, all of its paths."""
    match artist:
        case Line2D():
            return Path(np.column_stack(artist.get_data(orig=True)))
        case Patch():
            return artist.get_path()
        case _:
            return artist.get_paths()  # type: ignore[attr-defined]  # a collection's
