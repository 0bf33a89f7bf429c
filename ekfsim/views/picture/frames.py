"""The picture of a view as a frame with legend, close-up and captions.

Frame(scene, scope.of(scene, play(scene))).png(view)      # 900 pixels wide

On Axes of your own: views/notebook/drawing.py.
"""

from collections.abc import Iterator, Mapping
from typing import Any, Self

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.path import Path

from ekfsim.commands import expanded_length
from ekfsim.geometry.ellipse import outline
from ekfsim.scene import Scene
from ekfsim.views.film.png import Encoder, Pixels
from ekfsim.views.picture.artists import VERMILLION, empty
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.layout import (
    HIGHEST,
    JUDGED,
    MARGIN,
    NOTES,
    SPREAD,
    TITLE,
    WIDTH,
    arranged,
    fitting,
)
from ekfsim.views.picture.look import SCREEN, STANDARD, Look, Paper
from ekfsim.views.picture.panels import CloseUp, Main, reading
from ekfsim.views.picture.replay import Replay
from ekfsim.views.picture.written.legend import Key, Row
from ekfsim.views.picture.written.lettering import drawable, families, shortened, wrapped
from ekfsim.views.picture.written.names import Names
from ekfsim.views.picture.written.outlined import OutlinedText
from ekfsim.views.playback.view import View
from ekfsim.views.words.captions import notes, source, spread, title, too_large
from ekfsim.views.words.judgement import judgement, warns

WHOLE = (0, 0, 1, 1)  # of the figure, until everything is in its place
ROOMY = 14  # entries of the legend that stand in its place at ease
LETTERS, LINES = 13.7, 3  # of the notes: characters to an inch, and lines
TITLE_LETTERS = 9.5  # to an inch
WARNING, BLACK = "⚠ ", "#000000"  # before a judgement that warns; the colour of one that does not


class Picture:
    """Everything on one figure: the main picture, the close-up, legend and captions."""

    def __init__(self, figure: Figure, scene: Scene, scope: Scope, look: Look = STANDARD) -> None:
        self._scene, self._scope, self._probability = scene, scope, look.probability
        self._total = expanded_length(scene.commands)
        self.figure = figure
        figure.set_facecolor("white")
        probability, conditional = look.probability, look.conditional
        self.main = Main(figure.add_axes(WHOLE), scene, scope.base, probability, conditional)
        self.close = CloseUp(figure.add_axes(WHOLE, label="close"), scene, probability, conditional)
        self.title, self.judgement = self._text(13, "title"), self._text(9.5, "judgement")
        self.notes, self.spread = self._text(9.5, "notes"), self._text(8, "spread")
        self._source = figure.text(0, 0, drawable(source(scene)), fontsize=7, gid="source")
        self._source.set(family=families(), parse_math=False, ha="right", color="#555555")
        self.legend = Key(figure)  # what occurs in the view that is shown
        self.names = Names(self.main.axes, scene.world)
        self.arrange()

    @classmethod
    def on(cls, paper: Paper, scene: Scene, scope: Scope, look: Look = STANDARD) -> Self:
        """On a figure of its own."""
        figure = Figure(figsize=(WIDTH, HIGHEST), dpi=paper.dpi)
        FigureCanvasAgg(figure)
        picture = cls(figure, scene, scope, look)
        if paper.size is None:
            height = fitting(scope.base.shape, rows(picture.main)).height
            figure.set_size_inches(WIDTH, height)
        else:
            width, height = paper.size
            figure.set_size_inches(width / paper.dpi, height / paper.dpi)
        picture.arrange()
        return picture

    def arrange(self) -> None:
        """Put everything in its place, for the size that the figure has."""
        width, height = map(float, self.figure.get_size_inches())
        self._layout = layout = arranged(width, height, self._scope.base.shape, rows(self.main))
        self.main.axes.set_position(layout.share(layout.main))
        self.main.limit(self.main.asked)
        self.close.axes.set_position(layout.share(layout.close))
        left, bottom, *_ = layout.close
        self.title.place(MARGIN, height - TITLE)
        self.judgement.place(MARGIN, height - JUDGED)
        self.notes.place(MARGIN, NOTES)
        self.spread.place(left, bottom - SPREAD + 0.05)
        self._source.set_position((1 - MARGIN / width, 0.08 / height))
        self.legend.arrange(layout)
        self.legend.show_entries(self.main.handles())

    def show(self, view: View) -> bool:
        """Move everything to a view; whether it shows another part of the plane."""
        limits = self._scope.at(view)
        moved = limits != self.main.asked
        if moved:
            self.main.limit(limits)
        read = reading(view, self._scene)
        self.main.show(view, read)
        self.names.show(self.main.moving)
        self.close.show(self.main.shape, read, self._scope.base)
        self.legend.show_entries(self.main.handles())
        told = notes(view, self._scene, read, self._probability)
        x, P = view.pose
        if not view.unplaced and not self.main.limits.hold(
            outline(x, P[:2, :2], self._probability)
        ):
            told = [*told, too_large(view, self._probability)]
        across = self._layout.width - 2 * MARGIN
        columns = int(across * LETTERS)
        self.title.set_text(shortened(title(view, self._total), int(across * TITLE_LETTERS)))
        warned = warns(view, self._probability)
        judged = judgement(view, self._scene, self._probability, columns - len(WARNING))
        self.judgement.set_text(f"{WARNING if warned else ''}{judged}")
        self.judgement.set_facecolor(VERMILLION if warned else BLACK)
        self.notes.set_text("\n".join(wrapped(told, columns, LINES)))
        self.spread.set_text(spread(view, self._probability))
        return moved

    def moving(self) -> Iterator[Artist]:
        """What differs from view to view but for names, which are drawn first, and legend; in the
        order it is drawn.
        """
        yield from sorted(self.main.moving, key=Artist.get_zorder)
        yield from sorted(self.close.moving, key=Artist.get_zorder)
        yield from (self.title, self.judgement, self.notes, self.spread)

    def _text(self, points: float, gid: str) -> OutlinedText:
        inches = self.figure.dpi_scale_trans
        text = OutlinedText(0, 0, points, inches, inches, gid)
        self.figure.add_artist(text)
        return text


def rows(main: Main) -> int:
    """How many entries of the legend may stand below each other."""
    return min(len(list(main.handles())), ROOMY)


class Frame:
    """Pictures of one size, many of one scene:
    what stands still is drawn once, what moves for each view.
    """

    def __init__(
        self, scene: Scene, scope: Scope, look: Look = STANDARD, paper: Paper = SCREEN
    ) -> None:
        self.picture = Picture.on(paper, scene, scope, look)
        self._canvas: Any = self.picture.figure.canvas  # matplotlib leaves its methods untyped
        # of the legend, where each has stood: their pixels
        self._rows: dict[tuple[Row, tuple[float, float]], Any] = {}
        picture = self.picture
        for artist in (picture.names.artist, *picture.moving(), picture.legend):
            artist.set_animated(True)
        self._replay = Replay(self._canvas)
        self._draw_still()
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
        self._draw_ground()
        self._draw_legend()
        self._replay.draw(artist for artist in self.picture.moving() if not empty(artist))
        return np.asarray(self._canvas.buffer_rgba())

    def _draw_still(self) -> None:
        """Draw what does not move."""
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self.picture.figure.bbox)
        self._last: Path | None = None  # the names of the last view
        self._kept: tuple[Path, Any] | None = None  # names, and pixels that they are on

    def _draw_ground(self) -> None:
        """Draw what does not move and the names on it, which stay where they are for many views."""
        names = self.picture.names.artist
        letters = names.get_path()
        if self._kept is not None and self._kept[0] is letters:
            self._canvas.restore_region(self._kept[1])
            return
        self._canvas.restore_region(self._still)
        self._replay.draw([names])
        if letters is self._last:
            self._kept = letters, self._canvas.copy_from_bbox(self.picture.figure.bbox)
        self._last = letters

    def _draw_legend(self) -> None:
        """Draw each row of the legend, or put the pixels there with which it was drawn before."""
        legend = self.picture.legend
        for row in legend.rows():
            kept = self._rows.get((row, row.corner))
            if kept is not None:
                self._canvas.restore_region(kept)
            else:
                row.draw(self._canvas.get_renderer())
                self._rows[row, row.corner] = self._canvas.copy_from_bbox(legend.box(row))
