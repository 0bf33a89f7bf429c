"""Lines drawn in text: a canvas whose cells are braille characters of 2 × 4 dots,
or plain ASCII characters.

Points are in the drawing's own units (metres), y up, with the same scale on both axes: a cell of a
terminal is about twice as high as wide, so the dots of braille lie on a square grid. What lies
outside the bounds is cut off exactly, before it is turned into dots: a line of a million metres
costs no more than a short one.
"""

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import ArrayLike

from ekfsim.geometry import Array, Integers

Bounds = tuple[float, float, float, float]  # xmin, xmax, ymin, ymax

BLANK = 0x2800  # the braille character without dots
BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])  # of each dot of a cell
# of red, green and blue in the colour cube that all terminals share
LEVELS = (0, 95, 135, 175, 215, 255)
MARKERS = "*x?+>^<v"  # what a note does not cover, besides letters and numbers
# cells down, and its own lengths to the right, that a note is put beside a point
NEAR = (-1, 0), (0, 0), (-2, 0), (1, 0), (2, 0), (0, 1), (0, -1), (-1, 1), (-1, -1), (1, 1), (1, -1)
CONTROL_SEQUENCE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?")


@dataclass(frozen=True)
class Pen:
    """How a line looks. colour : parameters of the escape sequence that selects it;
    dashes are in dots.
    """

    colour: str = ""
    ascii: str = "#"  # what it draws with on a canvas without braille
    on: int = 1
    off: int = 0


def ansi(colour: str) -> str:
    """The nearest of the terminal's 216 cube colours to "#rrggbb", as escape sequence parameters.

    >>> ansi("#D55E00")
    '38;5;166'
    """
    red, green, blue = (
        min(range(6), key=lambda i: abs(LEVELS[i] - part))
        for part in bytes.fromhex(colour.removeprefix("#"))
    )
    return f"38;5;{16 + 36 * red + 6 * green + blue}"


class Canvas:
    """A drawing of `rows` lines of at most `columns` characters, centred on the bounds.
    The last to draw is on top.
    """

    def __init__(self, columns: int, rows: int, bounds: Bounds, ascii: bool = False) -> None:
        self.columns, self.rows, self.bounds, self.ascii = columns, rows, bounds, ascii
        self._cell = np.array([1, 1] if ascii else [2, 4])  # dots across and down a cell
        xmin, xmax, ymin, ymax = bounds
        dots = self._cell * [columns, rows]
        # dots across and down that cover the same length
        square = np.array([1.0, 0.5 if ascii else 1.0])
        extent = np.maximum([xmax - xmin, ymax - ymin], 1e-9)
        across = float(np.min(np.maximum(dots - 1, 1) / (extent * square)))
        # the length, in the drawing's units, that a cell is wide
        self.cell = int(self._cell[0]) / across
        self._scale = across * square * [1, -1]
        self._offset = (dots - 1) / 2 - np.array(
            [(xmin + xmax) / 2, (ymin + ymax) / 2]
        ) * self._scale
        self._size = dots
        self._dots = np.zeros((rows, columns), dtype=np.int64)  # bits of the braille character
        # what covers the dots, if anything
        self._characters = np.zeros((rows, columns), dtype="U1")
        self._colours = np.full((rows, columns), "", dtype=object)

    def polyline(self, points: ArrayLike, pen: Pen) -> None:
        """Draw a line through points : (n, 2); a single one is a dot.
        It is broken where a point is no number.

        Dashes run on around the corners.
        """
        points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        start, end = points[: max(len(points) - 1, 1)], points[-max(len(points) - 1, 1) :]
        start, end = clip(start, end, self.bounds)
        a, b = self._on_dots(start), self._on_dots(end)
        # in dots, as one goes from dot to dot, straight or across
        length = np.abs(b - a).max(axis=1, initial=0.0)
        count = np.ceil(length).astype(np.int64) + 1
        segment = np.repeat(np.arange(len(count)), count)
        along = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
        share = along / np.maximum(count - 1, 1)[segment]
        walked = (np.cumsum(length) - length)[segment] + share * length[segment]
        inked = _nearest(walked) % (pen.on + pen.off) < pen.on
        dots = (a[segment] + share[:, None] * (b - a)[segment])[inked]
        self._set(_nearest(dots), pen)

    def polygons(self, rings: Sequence[Array], pen: Pen) -> None:
        """Draw the closed lines through points : (n, 2) each."""
        self.polylines([np.concatenate([ring, ring[:1]]) for ring in rings], pen)

    def polylines(self, lines: Sequence[Array], pen: Pen) -> None:
        """Draw lines through points : (n, 2) each, thousands of them as fast as one."""
        if lines:
            lift = np.full((1, 2), np.nan)  # between two lines
            self.polyline(np.concatenate([part for line in lines for part in (line, lift)]), pen)

    def text(self, point: ArrayLike, text: str, colour: str = "") -> None:
        """Write a text, or a single marker, with its middle on a point : (2,);
        wide characters become `?`.
        """
        here = np.asarray(point, dtype=np.float64)
        if not inside(here, self.bounds):
            return
        column, row = _nearest(self._on_dots(here)) // self._cell
        text = "".join("?" if cells(c) > 1 else c for c in printable(text, self.ascii))
        for j, character in enumerate(text, start=int(column) - (len(text) - 1) // 2):
            if 0 <= j < self.columns:
                self._characters[row, j] = character
                self._colours[row, j] = colour

    def note(self, point: ArrayLike, text: str, colour: str = "") -> None:
        """Write a text near a point : (2,), where it covers neither another text nor a marker;
        nowhere where there is no such place.
        """
        here = np.asarray(point, dtype=np.float64)
        if not inside(here, self.bounds):
            return
        column, row = (_nearest(self._on_dots(here)) // self._cell).tolist()
        first = column - (len(text) - 1) // 2
        for down, right in NEAR:
            i, j = row + down, first + right * (len(text) + 1)
            if not (0 <= i < self.rows and j >= 0 and j + len(text) <= self.columns):
                continue
            covered = self._characters[i, max(j - 1, 0) : j + len(text) + 1]
            if not any(one.isalnum() or one in MARKERS for one in covered.tolist() if one):
                self._characters[i, j : j + len(text)] = list(text)
                self._colours[i, j : j + len(text)] = colour
                return

    def render(self, colour: bool = False) -> str:
        """The drawing, `rows` lines without blanks at their ends. colour : with escape sequences"""
        braille = np.where(self._dots > 0, (self._dots + BLANK).astype(np.uint32).view("U1"), " ")
        characters = np.where(self._characters != "", self._characters, braille)
        return "\n".join(
            _paint(row, colours) if colour else "".join(row).rstrip()
            for row, colours in zip(characters, self._colours, strict=True)
        )

    def _on_dots(self, points: Array) -> Array:
        """Points : (…, 2) within the bounds, counted in dots from the upper left one."""
        dots = points * self._scale + self._offset
        return np.clip(dots, 0, self._size - 1)  # rounding carries none off the canvas

    def _set(self, dots: Integers, pen: Pen) -> None:
        """Ink dots : (n, 2), columns and rows, all of them on the canvas."""
        column, row = (dots // self._cell).T
        if self.ascii:
            self._characters[row, column] = pen.ascii
        else:
            x, y = (dots % self._cell).T
            np.bitwise_or.at(self._dots, (row, column), BITS[y, x])
            self._characters[row, column] = ""
        self._colours[row, column] = pen.colour


def _nearest(dots: Array) -> Integers:
    """Whole dots. Every half goes the same way: to the even one each second would be left out."""
    return np.floor(dots + (0.5 + 1e-6)).astype(np.int64)


def clip(start: Array, end: Array, bounds: Bounds) -> tuple[Array, Array]:
    """The parts of the segments from start : (n, 2) to end :
    (n, 2) that lie within the bounds, m ≤ n of them.

    Liang and Barsky 1984: a + t (b − a) is inside where p t ≤ q for each of the four sides.

    >>> clip(np.array([[-1.0, 0.5]]), np.array([[3.0, 0.5]]), (0, 1, 0, 1))
    (array([[0. , 0.5]]), array([[1. , 0.5]]))
    """
    xmin, xmax, ymin, ymax = bounds
    with np.errstate(all="ignore"):  # points that are infinite or no number drop out by themselves
        d = end - start
        p = np.concatenate([-d, d], axis=1)
        q = np.concatenate([start - [xmin, ymin], [xmax, ymax] - start], axis=1)
        t = q / p
        enter = np.where(p < 0, t, 0.0).max(axis=1, initial=0.0)
        leave = np.where(p > 0, t, 1.0).min(axis=1, initial=1.0)
        visible = (
            (enter <= leave)
            & np.where(p == 0, q >= 0, True).all(axis=1)
            & np.isfinite(d).all(axis=1)
        )
        a, b = start + enter[:, None] * d, start + leave[:, None] * d
    low, high = [xmin, ymin], [xmax, ymax]  # rounding must not carry an end outside
    return np.clip(a, low, high)[visible], np.clip(b, low, high)[visible]


def inside(point: Array, bounds: Bounds) -> bool:
    """Whether a point : (2,) lies within the bounds; one that is no number does not."""
    xmin, xmax, ymin, ymax = bounds
    return bool(xmin <= point[0] <= xmax and ymin <= point[1] <= ymax)


def printable(text: str, ascii: bool = False) -> str:
    r"""A text that cannot disturb a line:
    one character in each place, no controls, no marks that combine.

    >>> printable("a\x1b[31m\tb\n c"), printable("Å → B", ascii=True)
    ('a b c', 'A ? B')
    """
    text = " ".join(CONTROL_SEQUENCE.sub("", text).split())
    text = unicodedata.normalize("NFKD" if ascii else "NFC", text)
    text = "".join(c for c in text if unicodedata.category(c)[0] not in "CM")
    return text.encode("ascii", errors="replace").decode() if ascii else text


def cells(text: str) -> int:
    """How many cells of a terminal a printable text takes: Chinese characters and emoji two each.

    >>> cells("desk"), cells("机")
    (4, 2)
    """
    return sum(2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text)


def shorten(text: str, columns: int, ascii: bool = False) -> str:
    """A printable text cut to so many cells, with an ellipsis where something is missing."""
    if cells(text) <= columns:
        return text
    text, ellipsis = text[:columns], ("..." if ascii else "…")[:columns]
    while cells(text) > columns - len(ellipsis):
        text = text[:-1]
    return text.rstrip() + ellipsis


def paint(text: str, colour: str) -> str:
    """A text in a colour, given as escape sequence parameters; as it is where there is none."""
    return f"\x1b[{colour}m{text}\x1b[0m" if colour and text.strip() else text


def _paint(characters: Array, colours: Array) -> str:
    """A line of characters, each run of one colour in one pair of escape sequences."""
    runs = groupby(
        zip(characters, colours, strict=True), key=lambda cell: "" if cell[0] == " " else cell[1]
    )
    return "".join(paint("".join(c for c, _ in run), str(colour)) for colour, run in runs).rstrip()
