"""How a terminal is divided: the lines of the screen for a moment, and nothing that writes them.

title, over the whole width
picture │ numbers          side by side, or one above the other, or one of the two
status line
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from ekfsim.printable import shown
from ekfsim.scene import Scene
from ekfsim.views.terminal.braille import (
    CONTROL_SEQUENCE,
    Bounds,
    Canvas,
    ansi,
    cells,
    paint,
    printable,
    shorten,
)
from ekfsim.views.terminal.drawing import PLAIN, depict, legend_lines, scale_bar, title
from ekfsim.views.terminal.images.images import Box
from ekfsim.views.terminal.readings import Item
from ekfsim.views.terminal.screens.moment import Moment
from ekfsim.views.terminal.wrapping import within, wrapped
from ekfsim.views.words.changes import losing
from ekfsim.views.words.judgement import judgement, warns
from ekfsim.views.words.verdict import meaning

# from so many columns side by side, from so many rows one above the other; the last column of a
# terminal is left free
WIDE, HIGH = 110 - 1, 36
NUMBERS = (48, 78)  # columns of the numbers beside a picture, from and to
SHARE = 0.42  # of the width for them
BAR = 3  # columns between the two
FLAT = 1.3  # how much larger a picture must become for the numbers to stand below it instead
HEADS, HEADS_NARROW = 4, 5  # rows for what the step was and how it is judged
TWO_LINES = 12  # rows of a picture from which on its legend may have two
NARRATIVE = 26  # rows of the numbers of a reading, as most of them are
WARNING_SIGN, WARNING = "⚠ ", "! "  # before a judgement that warns
BOLD, REVERSE, WARNED = "1", "7", "1;" + ansi("#D55E00")


class Panes(Enum):
    """What stands on the screen."""

    BOTH = "picture and numbers"
    PICTURE = "the picture"
    NUMBERS = "the numbers"


@dataclass(frozen=True, slots=True)
class Look:
    """What a screen may use."""

    colour: bool
    ascii: bool

    def strong(self, text: str, how: str = BOLD) -> str:
        """A text that stands out, where the terminal may."""
        return paint(text, how if self.colour else "")


def ample(columns: int, rows: int) -> bool:
    """Whether there is room for picture and numbers in one screen."""
    return columns >= WIDE or rows >= HIGH


@dataclass(frozen=True)
class Layout:
    """Divides a terminal of some size."""

    scene: Scene
    probability: float
    limits: Bounds  # what the picture shows, m
    shape: Bounds  # what the first picture shows, by which the screen is divided for the whole run
    columns: int
    rows: int
    look: Look
    imaged: bool = False  # whether the place of the picture is left to an image, which has a title

    def box(self, moment: Moment, panes: Panes) -> Box | None:
        """Where the picture stands; None where there is none."""
        heads = len(self._heads(moment))
        room = self.rows - heads - len(self._foot(moment, panes))
        if moment.page or panes is Panes.NUMBERS or room < 2:
            return None
        return Box(heads, 0, *self._share(panes, room))

    def lines(self, moment: Moment, panes: Panes, scroll: int | None) -> tuple[list[str], int]:
        """The lines of the screen, one for each row, and how far the numbers are scrolled.

        scroll : lines of the numbers above the pane; None: as far as this view's own begin, where
        they would not be seen
        """
        foot = self._foot(moment, panes)
        if moment.page:
            page = _page(moment.page, self.columns)
            lines, scroll = self._scrolled(page, self.columns, self.rows - len(foot), scroll or 0)
            return [*_filled(lines, self.rows - len(foot)), *foot][-self.rows :], scroll
        heads = self._heads(moment)
        room = self.rows - len(heads) - len(foot)
        if room < 2:
            return [*heads, *foot][: self.rows - 1] + foot[-1:], 0
        body, scroll = self._body(moment, panes, room, scroll)
        return [*heads, *_filled(body, room), *foot], scroll

    def _heads(self, moment: Moment) -> list[str]:
        """What the step was and how its belief is to be judged; in every view of a run as many
        lines, so that the picture stays where it is.
        """
        if self.imaged:
            return []
        view, ascii = moment.view, self.look.ascii
        rows = min(HEADS if self.columns >= WIDE else HEADS_NARROW, max(self.rows // 4, 1))
        lines = within(title(view, self.scene, self.probability, ascii), self.columns,
                       max(rows - 1, 1), ascii)  # fmt: skip
        lines = [self.look.strong(line) for line in lines]
        warned = warns(view, self.probability)
        sign = (WARNING if ascii else WARNING_SIGN) if warned else ""
        several = 2 if view.others and rows - len(lines) > 1 else 1  # lines: each has its own
        room = several * (self.columns - len(sign))
        judged = sign + judgement(view, self.scene, self.probability, room)
        for told in (judged, losing(view, self.scene.watching) or meaning(view, self.scene)):
            if told and len(lines) < rows:
                told = printable(told.translate(PLAIN), True) if ascii else printable(told)
                more = within(told, self.columns, rows - len(lines), ascii)
                lines += [self.look.strong(line, WARNED if warned else BOLD) for line in more]
        return _filled(lines, rows)

    def _body(
        self, moment: Moment, panes: Panes, room: int, scroll: int | None
    ) -> tuple[list[str], int]:
        if panes is Panes.NUMBERS:
            return self._numbers(moment, self.columns, room, scroll)
        columns, rows = self._share(panes, room)
        picture = self._picture(moment, columns, rows)
        if panes is Panes.PICTURE:
            return picture, 0
        if columns == self.columns:
            numbers, scroll = self._numbers(moment, columns, room - rows - 1, scroll)
            return [*picture, ("-" if self.look.ascii else "─") * columns, *numbers], scroll
        numbers, scroll = self._numbers(moment, self.columns - columns - BAR, room, scroll)
        bar = " | " if self.look.ascii else " │ "
        return [
            (f"\x1b[{columns}C" if self.imaged else _padded(one, columns)) + bar + other
            for one, other in zip(picture, _filled(numbers, room), strict=True)
        ], scroll

    def _share(self, panes: Panes, room: int) -> tuple[int, int]:
        """Columns and rows of the picture; with numbers beside it, or below where it is as wide as
        the screen.
        """
        if panes is Panes.PICTURE:
            return self.columns, room
        beside = min(max(round(SHARE * self.columns), NUMBERS[0]), NUMBERS[1])
        left = self.columns - beside - BAR
        if self.columns < WIDE or (self.rows >= HIGH and self._flat(left, room)):
            high = min(max(room - NARRATIVE - 1, (room + 1) // 2), self._needed(self.columns))
            return self.columns, high
        return left, room

    def _picture(self, moment: Moment, columns: int, rows: int) -> list[str]:
        """The picture with its legend, in exactly so many rows."""
        if self.imaged:
            return [""] * rows
        two = 2 if rows > TWO_LINES else 1
        canvas = Canvas(columns, max(rows - two, 1), self.limits, self.look.ascii)
        items = depict(canvas, moment.view, self.scene, self.probability)
        items.append(Item(*scale_bar(canvas).split(" ", 1)))
        drawn = canvas.render(self.look.colour).split("\n")
        legend = legend_lines(items, columns, two, self.look.colour, self.look.ascii)
        return _filled([*drawn, *legend], rows)

    def _numbers(
        self, moment: Moment, columns: int, rows: int, scroll: int | None
    ) -> tuple[list[str], int]:
        """The narrative of the step, as far as there is room; and how far it is scrolled."""
        lines, own = self._wrapped(moment, columns)
        if scroll is None:  # the newest is seen whole, or at least from its beginning
            scroll = max(own - 1, 0)
        lines, scroll = self._scrolled(lines, columns, rows, scroll)
        return [
            self.look.strong(line) if line.startswith("==>") else line for line in lines
        ], scroll

    def _wrapped(self, moment: Moment, columns: int) -> tuple[list[str], int]:
        """The narrative of the step in lines, and at which of them that of this view begins."""
        before = self._broken(moment.before, columns)
        return [*before, *self._broken(moment.narrative, columns)], len(before)

    def _broken(self, text: str, columns: int) -> list[str]:
        if self.look.ascii:
            text = text.translate(PLAIN).encode("ascii", "replace").decode()
        lines = shown(text).rstrip("\n").split("\n") if text else []
        return [part for line in lines for part in wrapped(line, columns)]

    def _scrolled(
        self, lines: list[str], columns: int, rows: int, scroll: int
    ) -> tuple[list[str], int]:
        """So many of the lines as fit, with signs where there are more."""
        if len(lines) <= rows or rows < 3:
            return lines[:rows], 0
        up, down = ("^", "v") if self.look.ascii else ("▲", "▼")
        scroll = min(scroll, len(lines) - rows)
        above = [self._sign(f"{up} {scroll + 1} more: k", columns)] if scroll > 0 else []
        first = scroll + 1 if scroll > 0 else 0  # the sign takes a row
        left = len(lines) - first - (rows - len(above))
        if left <= 0:
            return [*above, *lines[first:]], scroll
        below = [self._sign(f"{down} {left + 1} more: j", columns)]
        return [*above, *lines[first : first + rows - len(above) - 1], *below], scroll

    def _sign(self, text: str, columns: int) -> str:
        return self.look.strong(shorten(text, columns, self.look.ascii), REVERSE)

    def _foot(self, moment: Moment, panes: Panes) -> list[str]:
        """The status line; more than one where what there is to say is longer."""
        place = moment.place + (f" · {moment.typed}" if moment.typed else "")
        notes = [" ".join(line.split()) for line in shown(moment.note).split("\n")]
        note = " ".join(notes)
        hints = [*moment.hints[:2], self._other(panes), *moment.hints[2:]]
        if moment.page:
            place = moment.page_name or "the keys"
            hints = ["n goes on", "any other key: back to the run"]
        if len(notes) > 1:
            lines = self._cut([place, *notes])
        elif note:
            told = f"{place} · {note}"
            lines = [told] if cells(told) <= self.columns else within(note, self.columns, 3, False)
        else:
            lines = [_hinted(place, hints, self.columns)]
        lines = lines[: max(self.rows // (2 if len(notes) > 1 else 3), 1)]
        if self.look.ascii:
            lines = [printable(line.translate(PLAIN), True) for line in lines]
        lines = [shorten(line, self.columns, self.look.ascii) for line in lines]
        return [self.look.strong(_padded(line, self.columns), REVERSE) for line in lines]

    def _cut(self, texts: list[str]) -> list[str]:
        """Several texts in lines, of which at most half of the screen is taken."""
        lines = [part for text in texts for part in wrapped(text, self.columns)]
        most = max(self.rows // 2, 2)
        if len(lines) > most:
            lines = [*lines[: most - 1], f"… {len(lines) - most + 1} more lines"]
        return lines

    def _other(self, panes: Panes) -> str:
        return f"v {(Panes.NUMBERS if panes is Panes.PICTURE else Panes.PICTURE).value}"

    def _flat(self, left: int, room: int) -> bool:
        """Whether a picture over the whole width, with numbers below, is much the larger."""
        left_x, right, bottom, top = self.shape
        width, height = max(right - left_x, 1e-9), max(top - bottom, 1e-9)
        beside = min(left / width, 2 * room / height)
        above = min(self.columns / width, room / height)  # half of the rows
        return above > FLAT * beside

    def _needed(self, columns: int) -> int:
        """The rows that a picture of so many columns fills, with its legend."""
        left, right, bottom, top = self.shape
        shape = max(top - bottom, 1e-9) / max(right - left, 1e-9)
        return min(math.ceil(columns * shape / 2) + 2, self.rows)


def _hinted(place: str, hints: Sequence[str], columns: int) -> str:
    """A place, and as many hints as there is room for; the one on all keys gives way last."""
    for most in (*range(len(hints), 1, -1), 1):
        line = " · ".join([place, *(hints[:most] if most > 1 else hints[1:2])])
        if cells(line) <= columns:
            return line
    return place


def _page(text: str, columns: int) -> list[str]:
    """A page of text in lines; what stands side by side in it stands below where it is narrow."""
    lines = []
    for line in text.split("\n"):
        parts = [line] if cells(line) <= columns else re.split(" {3,}", line)
        lines += [piece for part in parts for piece in wrapped(part, columns)]
    return lines


def _filled(lines: list[str], rows: int) -> list[str]:
    return [*lines[:rows], *[""] * (rows - len(lines))]


def _padded(line: str, columns: int) -> str:
    """A line, coloured or not, with blanks up to so many cells."""
    return line + " " * (columns - cells(CONTROL_SEQUENCE.sub("", line)))
