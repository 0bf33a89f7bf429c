"""The picture of a view: on Axes of your own, or as a frame with legend, close-up and captions.

draw(view, scene, ax)                                      # in a notebook
Frame(scene, limits.of(scene, play(scene))).png(view)      # 900 × 700 pixels
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerPathCollection, HandlerTuple
from matplotlib.text import Text

from ekfsim.commands import expanded_length
from ekfsim.geometry.ellipse import outline
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.film.png import Encoder, Pixels
from ekfsim.views.picture import limits as limits_of_run
from ekfsim.views.picture.artists import VERMILLION, empty
from ekfsim.views.picture.labels import label_landmarks, label_obstacles
from ekfsim.views.picture.lettering import drawable, families, wrapped
from ekfsim.views.picture.limits import Limits, including
from ekfsim.views.picture.look import STANDARD, Look
from ekfsim.views.picture.outlined import OutlinedText
from ekfsim.views.picture.panels import CloseUp, Main, reading
from ekfsim.views.picture.replay import Replay
from ekfsim.views.playback.view import View
from ekfsim.views.words.captions import notes, source, spread, title, too_large
from ekfsim.views.words.judgement import judgement, warns

INCHES, DPI = (9.0, 7.0), 100  # 900 × 700 pixels
MAIN = (0.085, 0.08, 0.58, 0.76)  # left, bottom, width, height as shares of the figure
CLOSE = (0.7, 0.08, 0.28, 0.36)
HANDLERS: dict[type, Any] = {
    tuple: HandlerTuple(ndivide=1),
    PathCollection: HandlerPathCollection(numpoints=5),
}
ROOMY = 15  # entries of the legend that stand in its place at ease
COLUMNS, LINES = 118, 3  # of the notes: characters in a line, and lines
WARNING, BLACK = "⚠ ", "#000000"  # before a judgement that warns; the colour of one that does not


def draw(
    view: View | Step, scene: Scene, ax: Axes, look: Look = STANDARD, limits: Limits | None = None
) -> Main:
    """Draw world, belief, truth and beam on Axes of your own, with a legend.

    A Step is drawn as it ended. Without limits the picture fits this view alone. What comes back
    moves the same artists: `picture = draw(view, scene, ax)`, then `picture.show(other, None)`.
    """
    if isinstance(view, Step):
        view = View(0, view)
    main = Main(
        ax,
        scene,
        limits or limits_of_run.of(scene, [view.step], look.probability),
        look.probability,
        look.conditional,
    )
    main.show(view, reading(view, scene))
    handles, words = _legend(main.handles())
    ax.legend(handles, words, fontsize=8, handler_map=HANDLERS)
    return main


class Picture:
    """Everything on one figure: the main picture, the close-up, legend and captions."""

    def __init__(self, figure: Figure, scene: Scene, limits: Limits, look: Look = STANDARD) -> None:
        self._scene, self._probability = scene, look.probability
        self._total = expanded_length(scene.commands)
        self.figure = figure
        figure.set_facecolor("white")
        self.main = Main(figure.add_axes(MAIN), scene, limits, look.probability, look.conditional)
        self.close = CloseUp(figure.add_axes(CLOSE), scene, look.probability, look.conditional)
        self.title = self._text(0.02, 0.955, 13, "title")
        self.judgement = self._text(0.02, 0.928, 9.5, "judgement")
        self.notes = self._text(0.02, 0.902, 9.5, "notes")
        self.spread = self._text(CLOSE[0], 0.052, 8, "spread")
        made = figure.text(
            0.98,
            0.012,
            drawable(source(scene)),
            fontsize=7,
            ha="right",
            color="#555555",
            gid="source",
        )
        made.set(family=families(), parse_math=False)
        handles, words = _legend(self.main.handles())
        crowded = len(handles) > ROOMY
        self.legend = figure.legend(
            handles, words, loc="upper left", bbox_to_anchor=(CLOSE[0] - 0.015, 0.845),
            borderaxespad=0.0,
            fontsize=6.3 if crowded else 8, labelspacing=0.1 if crowded else 0.45, handlelength=2.4,
            frameon=False,
            handler_map=HANDLERS,
        )  # fmt: skip
        for words_of in self.legend.get_texts():
            words_of.set(family=families(), parse_math=False)
        self.names: list[Text] = []

    def label(self) -> None:
        """Write the obstacles' names and the landmarks' numbers where the present limits leave room
        for them.
        """
        for name in self.names:
            name.remove()
        world, axes = self._scene.world, self.main.axes
        names = label_obstacles(axes, world.map)
        self.names = [*names, *label_landmarks(axes, world.landmarks, names)]

    def show(self, view: View) -> bool:
        """Move everything to a view; whether the limits had to grow for it."""
        needed = including(self.main.limits, view)
        grown = needed != self.main.limits
        if grown:
            self.main.limit(needed)
        read = reading(view, self._scene)
        self.main.show(view, read)
        self.close.show(view, read, self.main.limits)
        told = notes(view, self._scene, read, self._probability)
        x, P = view.pose
        if not self.main.limits.hold(outline(x, P[:2, :2], self._probability)):
            told = [*told, too_large(view, self._probability)]
        self.title.set_text(title(view, self._total))
        warned = warns(view, self._probability)
        judged = judgement(view, self._scene, self._probability, COLUMNS - len(WARNING))
        self.judgement.set_text(f"{WARNING if warned else ''}{judged}")
        self.judgement.set_facecolor(VERMILLION if warned else BLACK)
        self.notes.set_text("\n".join(wrapped(told, COLUMNS, LINES)))
        self.spread.set_text(spread(view, self._probability))
        return grown

    def moving(self) -> Iterator[Artist]:
        """What differs from view to view, in the order it is drawn."""
        yield from sorted(self.main.moving, key=Artist.get_zorder)
        yield from sorted(self.close.moving, key=Artist.get_zorder)
        yield from (self.title, self.judgement, self.notes, self.spread)

    def _text(self, x: float, y: float, points: float, gid: str) -> OutlinedText:
        text = OutlinedText(x, y, points, self.figure.transFigure, self.figure.dpi_scale_trans, gid)
        self.figure.add_artist(text)
        return text


class Frame:
    """Pictures of 900 × 700 pixels, many of one scene:
    what stands still is drawn once, what moves for each view.
    """

    def __init__(
        self, scene: Scene, limits: Limits, look: Look = STANDARD, legend: bool = True
    ) -> None:
        figure = Figure(figsize=INCHES, dpi=DPI)
        self._canvas: Any = FigureCanvasAgg(figure)  # matplotlib leaves its methods untyped
        self.picture = Picture(figure, scene, limits, look)
        self.picture.legend.set_visible(legend)
        for artist in self.picture.moving():
            artist.set_animated(True)
        self._draw_still()
        self._replay = Replay(self._canvas)
        width, height = self._canvas.get_width_height()
        self._encoder = Encoder(height, width)

    def rgb(self, view: View) -> Pixels:
        """The pixels of a view : (h, w, 3)"""
        rgba = self.rgba(view)
        pixels = np.empty((*rgba.shape[:2], 3), np.uint8)
        for channel in range(3):  # three times as fast as all at once
            pixels[..., channel] = rgba[..., channel]
        return pixels

    def png(self, view: View, metadata: Mapping[str, str] | None = None) -> bytes:
        """The picture of a view as a PNG file; equal views give equal bytes."""
        return self._encoder.encode(self.rgba(view), metadata or {})

    def rgba(self, view: View) -> Pixels:
        """The canvas with a view on it, until the next : (h, w, 4)"""
        if self.picture.show(view):
            self._draw_still()
        self._canvas.restore_region(self._still)
        self._replay.draw(artist for artist in self.picture.moving() if not empty(artist))
        return np.asarray(self._canvas.buffer_rgba())

    def _draw_still(self) -> None:
        """Draw what does not move."""
        self.picture.label()
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self.picture.figure.bbox)


def _legend(handles: Iterable[Artist | tuple[Artist, ...]]) -> tuple[list[Any], list[str]]:
    """Handles, on top of each other where they are a tuple (which matplotlib's types do not know),
    and their words.
    """
    shown = list(handles)
    words = [
        str((handle[0] if isinstance(handle, tuple) else handle).get_label()) for handle in shown
    ]
    # matplotlib leaves out what begins with _, as the name of a file may
    return shown, [drawable(f" {word}" if word.startswith("_") else word) for word in words]
