"""Lines and patches drawn again and again, as matplotlib draws them.

matplotlib asks an artist for its whole style each time, which takes longer than to draw it. Here
the style is asked for once, and again when it changes; what moves is asked for each time.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path
from matplotlib.transforms import Transform


class Stroke(NamedTuple):
    """One call of a renderer, without the path and where it lies."""

    context: Any  # width, dashes, clipping, …
    face: Any
    marker: tuple[Any, ...] = ()  # path and transform of what is drawn at each corner


class Recorder:
    """A renderer that remembers the strokes drawn with it."""

    def __init__(self, renderer: Any) -> None:
        self._renderer = renderer
        self.strokes: list[Stroke] = []

    def __getattr__(self, name: str) -> Any:
        """Whatever else a renderer can do."""
        return getattr(self._renderer, name)

    def draw_path(self, context: Any, path: Path, transform: Transform, face: Any = None) -> None:
        """Draw a path, and remember how."""
        self.strokes.append(Stroke(context, face))
        self._renderer.draw_path(context, path, transform, face)

    def draw_markers(
        self,
        context: Any,
        marker: Path,
        marker_transform: Transform,
        path: Path,
        transform: Transform,
        face: Any = None,
    ) -> None:
        """Draw a marker at each corner of a path, and remember how."""
        self.strokes.append(Stroke(context, face, (marker, marker_transform.frozen())))
        self._renderer.draw_markers(context, marker, marker_transform, path, transform, face)


class Replay:
    """Draws artists on one canvas, with the strokes that each was drawn with the last time.

    Patches are taken to keep their style, and all coordinate systems to be linear.
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
            self._repeat(strokes, _path(artist), places[id(system)])

    def _repeat(self, strokes: Iterable[Stroke], path: Path, place: Any) -> None:
        for context, face, marker in strokes:
            if marker:
                self._renderer.draw_markers(context, *marker, path, place, face)
            else:
                self._renderer.draw_path(context, path, place, face)


def _repeatable(artist: Artist) -> bool:
    """Whether an artist's strokes follow its whole path, one after another."""
    return not artist.get_path_effects() and (
        isinstance(artist, Patch) or (isinstance(artist, Line2D) and artist.get_markevery() is None)
    )


def _style(artist: Artist) -> object:
    """What tells whether an artist is to be drawn as before."""
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


def _path(artist: Artist) -> Path:
    if isinstance(artist, Patch):
        return artist.get_path()
    assert isinstance(artist, Line2D)
    return Path(np.column_stack(artist.get_data(orig=True)))
