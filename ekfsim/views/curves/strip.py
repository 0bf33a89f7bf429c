"""The curves of a run as a strip beneath its pictures: drawn once, a cursor moves."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from ekfsim.errors import UsageError
from ekfsim.scene import Scene
from ekfsim.views.curves.bands import ErrorPanel, InnovationPanel
from ekfsim.views.curves.panels import Panel, draw_panels, over_steps, panels_of
from ekfsim.views.curves.series import Series
from ekfsim.views.film.png import Encoder, Pixels
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.frames import Frame
from ekfsim.views.picture.look import LOWEST, STANDARD, Look, Paper
from ekfsim.views.playback.view import View

HEIGHT = 2.4  # in
ROUNDING = 1e-6  # px: a canvas has no part of a pixel, and a quotient may fall short of one
LEFT, BETWEEN, RIGHT, TOP, BOTTOM, GAP = 0.65, 0.65, 0.12, 0.12, 0.36, 0.08  # in, around the panels
LETTERS, SMALL = 6.5, 0.6  # points; the size of a dot beside that of a plot
TICKS = 3  # about so many on a small axis
YET = "white"  # the veil over what is yet to come
COMING = 0.65  # how dense it is


class Strip:
    """The panels of a run, small: errors or innovations at the left, NIS and NEES at the right."""

    def __init__(
        self, runs: Sequence[Series], width: int, dpi: float,
        probability: float = STANDARD.probability,
    ) -> None:  # fmt: skip
        """width : px"""
        self._run = runs[0]
        inches = (width + ROUNDING) / dpi, HEIGHT
        figure = Figure(figsize=inches, dpi=dpi, facecolor="white")
        self._canvas: Any = FigureCanvasAgg(figure)  # matplotlib leaves its methods untyped
        self.height: int = self._canvas.get_width_height()[1]  # px
        self.axes = _drawn(figure, panels_of(runs, probability), runs)
        self.cursors = [own.add_line(Line2D([0, 0], [0, 1], color="black", lw=1.2, zorder=8,
                        transform=own.get_xaxis_transform(), gid="cursor"))
                        for own in self.axes]  # fmt: skip
        self.veils = [own.add_patch(Rectangle((0, 0), 0, 1, color=YET, alpha=COMING, lw=0,
                      transform=own.get_xaxis_transform(), zorder=7, gid="veil"))
                      for own in self.axes]  # fmt: skip
        for artist in (*self.cursors, *self.veils):
            artist.set_animated(True)
        self._draw_still(figure)

    def rgba(self, view: View) -> Pixels:
        """The canvas with the cursor at a view, until the next : (h, w, 4)"""
        self.show(view)
        self._canvas.restore_region(self._still)
        renderer = self._canvas.get_renderer()
        for artist in (*self.veils, *self.cursors):
            artist.draw(renderer)
        return np.asarray(self._canvas.buffer_rgba())

    def show(self, view: View) -> None:
        """Move the cursor to the step of a view, and the veil behind it."""
        row = int(np.searchsorted(self._run.index, view.step.entry.index))
        x, end = float(self._run.abscissa[row]), float(self._run.abscissa[-1])
        for cursor, veil in zip(self.cursors, self.veils, strict=True):
            cursor.set_xdata([x, x])
            veil.set(x=x, width=end - x)

    def _draw_still(self, figure: Figure) -> None:
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(figure.bbox)


class Stripped:
    """Pictures with the strip beneath them, in place of those of a frame."""

    def __init__(
        self, frame: Frame, runs: Sequence[Series], probability: float = STANDARD.probability
    ) -> None:
        figure = frame.picture.figure
        self._frame = frame
        width, height = figure.canvas.get_width_height()
        self.strip = Strip(runs, width, figure.dpi, probability)
        height += self.strip.height
        self._pixels = np.empty((height, width, 4), np.uint8)
        self._encoder = Encoder(height, width)

    def rgba(self, view: View) -> Pixels:
        """The picture of a view with the strip, until the next : (h, w, 4)"""
        above, beneath = self._frame.rgba(view), self.strip.rgba(view)
        self._pixels[: len(above)] = above
        self._pixels[len(above) :] = beneath
        return self._pixels

    def rgb(self, view: View) -> Pixels:
        """Its pixels without transparency : (h, w, 3)"""
        return np.ascontiguousarray(self.rgba(view)[..., :3])

    def png(self, view: View, metadata: Mapping[str, str] | None = None) -> bytes:
        """It as a PNG file; equal views give equal bytes."""
        return self._encoder.encode(self.rgba(view), metadata or {})


def framed(
    scene: Scene, scope: Scope, look: Look, paper: Paper, runs: Sequence[Series]
) -> Frame | Stripped:
    """What draws the pictures of a scene: with the strip, where there are curves.

    Raises UsageError where the paper has no room for both.
    """
    if not runs:
        return Frame(scene, scope, look, paper)
    if paper.size is not None:
        width, height = paper.size
        left = height - int(HEIGHT * paper.dpi)
        if left < LOWEST * paper.dpi:
            raise UsageError(
                f"--size {width}x{height}: --strip takes {height - left} rows of it, and leaves "
                "too few for the picture; choose a larger --size or a smaller --dpi"
            )
        paper = replace(paper, size=(width, left))
    return Stripped(Frame(scene, scope, look, paper), runs, look.probability)


def _drawn(figure: Figure, panels: Sequence[Panel], runs: Sequence[Series]) -> list[Axes]:
    """The panels in two columns, drawn."""
    first = [panel for panel in panels if isinstance(panel, ErrorPanel | InnovationPanel)]
    columns = [column for column in (first, panels[len(first) :]) if column]
    places = _places(figure, [len(column) for column in columns])
    axes = [figure.add_axes(place, label=f"strip-{i}") for i, place in enumerate(places)]
    draw_panels(panels, axes, runs)
    for panel, own in zip(panels, axes, strict=True):
        over_steps(own, runs[0], any(panel is column[-1] for column in columns))
        _make_small(own)
    return axes


def _make_small(axes: Axes) -> None:
    """Letters, ticks and dots for a small place."""
    axes.tick_params(labelsize=LETTERS, length=2, pad=2)
    quantity, _, _ = axes.get_ylabel().partition("\n")
    axes.set_ylabel(quantity, fontsize=LETTERS)
    axes.set_xlabel(axes.get_xlabel(), fontsize=LETTERS, labelpad=1)
    if axes.get_yscale() == "linear":
        axes.locator_params(axis="y", nbins=TICKS)
    for line in axes.get_lines():
        line.set(markersize=SMALL * line.get_markersize(), clip_on=True)


def _places(figure: Figure, columns: Sequence[int]) -> Iterator[tuple[float, float, float, float]]:
    """Where each panel stands, as shares of the figure: left, bottom, width, height.
    columns : how many panels each holds
    """
    width, height = map(float, figure.get_size_inches())
    wide = (width - LEFT - RIGHT - BETWEEN * (len(columns) - 1)) / len(columns)
    for i, count in enumerate(columns):
        high = (height - TOP - BOTTOM - GAP * (count - 1)) / count
        for n in range(count):
            bottom = height - TOP - high - n * (high + GAP)
            left = LEFT + i * (wide + BETWEEN)
            yield left / width, bottom / height, wide / width, high / height
