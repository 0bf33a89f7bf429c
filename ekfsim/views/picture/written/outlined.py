"""Text that changes from picture to picture, drawn from outlines that are kept:
matplotlib's own is 20 times slower.
"""

import unicodedata
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.textpath import text_to_path
from matplotlib.transforms import Affine2D, Bbox, ScaledTranslation, Transform
from numpy.typing import NDArray

from ekfsim.geometry import Array
from ekfsim.views.picture.written.lettering import drawable, families

SPACING = 1.45  # from line to line, in heights of the letters
# vertices (n, 2) and codes (n,) of a path, FONT_SCALE units to the em
Outline = tuple[Array, NDArray[np.uint8]]
NOTHING: Outline = np.empty((0, 2)), np.empty(0, np.uint8)
WORDS = 1024  # that are kept: most are said again in the next picture
PER_POINT = 1 / 72 / text_to_path.FONT_SCALE  # inches per point and unit of an outline


class OutlinedText(PathPatch):
    """Lines of text. Their first baseline begins at (x, y) of the coordinate system given."""

    def __init__(
        self,
        x: float,
        y: float,
        points: float,
        system: Transform,
        inches: Transform,
        gid: str,
        halo: bool = False,
    ) -> None:
        """points : the letters' size; inches : the figure's dpi_scale_trans; halo : a white rim"""
        self._letters, self._system = Affine2D().scale(points * PER_POINT) + inches, system
        super().__init__(
            Path(np.empty((0, 2))),
            facecolor="black",
            linewidth=0,
            gid=gid,
            zorder=7,
        )
        self._text = ""
        self.place(x, y)
        if halo:
            self.set_path_effects([withStroke(linewidth=3, foreground="white")])

    def place(self, x: float, y: float) -> None:
        """Begin the first baseline elsewhere."""
        # any affine transform will do
        self.set_transform(self._letters + ScaledTranslation(x, y, self._system))  # type: ignore[arg-type]

    def set_text(self, text: str) -> None:
        """Show another text, in as many lines as it has."""
        if (shown := drawable(text)) == self._text:
            return
        self._text = shown
        down = -SPACING * text_to_path.FONT_SCALE
        outlines, places = [NOTHING], [(0.0, 0.0)]
        for i, line in enumerate(shown.split("\n")):
            for outline, right in _line(line):
                outlines.append(outline)
                places.append((right, i * down))
        self.set_path(Path(*_joined(outlines, places)))

    def get_window_extent(self, renderer: Any = None) -> Bbox:
        """The box of all corners, which to look for where each curve turns takes 100 times as
        long.
        """
        vertices = np.asarray(self.get_path().vertices, float)
        if not len(vertices):
            return Bbox.null()
        corners = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
        return Bbox(self.get_transform().transform(corners))

    def get_text(self) -> str:
        """The text shown."""
        return self._text


@cache
def lettered(text: str) -> tuple[Outline, float]:
    """The outline of a line of text that begins at (0, 0), and how wide it is."""
    glyphs = [(NOTHING, 0.0), *_line(text)]
    outlines = [outline for outline, _ in glyphs]
    return _joined(outlines, [(right, 0.0) for _, right in glyphs]), _width(text)


def _joined(outlines: list[Outline], places: list[tuple[float, float]]) -> Outline:
    """Several outlines as one, each moved to its place."""
    vertices, codes = zip(*outlines, strict=True)
    offsets = np.repeat(places, [len(each) for each in codes], axis=0)
    return np.concatenate(vertices) + offsets, np.concatenate(codes)


def _line(text: str) -> Iterator[tuple[Outline, float]]:
    """The words of a line, and how far to the right each begins."""
    if not text.isascii() and any(map(_shaped, text)):
        yield _outline(text), 0.0
        return
    right = 0.0
    for i, word in enumerate(text.split(" ")):
        if i:
            right += _advance(" ")
        outline, width = _word(word)
        yield outline, right
        right += width


def _shaped(sign: str) -> bool:
    """Whether a sign's shape or place depends on its neighbours, as in Arabic or Devanagari."""
    return sign > "\u02ff" and (
        unicodedata.category(sign)[0] == "M"
        or unicodedata.bidirectional(sign) in ("R", "AL")
        or sign == "\u200d"
    )


@lru_cache(WORDS)
def _word(text: str) -> tuple[Outline, float]:
    """The outline of a word that begins at (0, 0), and how far what follows it is."""
    right, glyphs, places = 0.0, [NOTHING], [(0.0, 0.0)]
    for sign in text:
        glyphs.append(_glyph(sign))
        places.append((right, 0.0))
        right += _advance(sign)
    return _joined(glyphs, places), right


@cache
def _glyph(sign: str) -> Outline:
    return NOTHING if sign.isspace() else _outline(sign)


@cache
def _advance(sign: str) -> float:
    """How far the next sign is: what a sign adds between two others."""
    return _width(f"n{sign}n") - _width("nn")


def _outline(text: str) -> Outline:
    vertices, codes = text_to_path.get_text_path(_font(), text)
    return np.asarray(vertices, float).reshape(-1, 2), np.asarray(codes, np.uint8)


def _width(text: str) -> float:
    width: float = text_to_path.get_text_width_height_descent(text, _font(), ismath=False)[0]
    return width / _font().get_size_in_points() * text_to_path.FONT_SCALE


@cache
def _font() -> FontProperties:
    return FontProperties(family=families())
