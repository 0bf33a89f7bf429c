"""A terminal with the run on one screen, redrawn in place."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from io import StringIO

from ekfsim.scene import Scene
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.braille import Bounds, shorten
from ekfsim.views.terminal.images.images import Box, Images
from ekfsim.views.terminal.keys.bindings import Action
from ekfsim.views.terminal.screens.layout import Layout, Look, Panes, ample
from ekfsim.views.terminal.screens.moment import Moment

WIDEST, HIGHEST = 1000, 300  # columns and rows of a screen, whatever COLUMNS and LINES say
OTHER_SCREEN, OWN_SCREEN = "\x1b[?1049h\x1b[?25l", "\x1b[?25h\x1b[?1049l"
PRINTED = 20  # lines of what a filter prints that are shown, the last of them
CLEARED = "\x1b[2J"
END = "\x1b\\"  # of what a terminal is told in a string
LEFT = 20  # views whose narrative stays on the terminal when the run is left


class Console:
    """Shows a moment on the terminal's second screen; what stood on the first comes back at the
    end, and below it what has been read.
    """

    keeps = False

    def __init__(
        self,
        scene: Scene,
        extent: Scope,
        probability: float,
        look: Look,
        write: Callable[[str], object],
        panes: Panes | None = None,
        size: Callable[[], tuple[int, int]] = shutil.get_terminal_size,
    ) -> None:
        self._scene, self._extent, self._probability = scene, extent, probability
        self._look, self.write, self._size = look, write, size
        self.panes = panes  # what was asked for; None: as much as there is room for
        self._scroll: int | None = None  # None: to where the numbers of this view begin
        self._scrolled = 0  # where that was
        self._moment: Moment | None = None
        self._read: dict[int, str] = {}  # narrative of what has been on the screen, by view
        self.images: Images | None = None  # what draws the picture, where not its characters
        self._drawn: list[str] = []  # the lines that stand there
        self._drawn_for = (0, 0)
        self._box: Box | None = None  # where an image stands
        self._pictured: View | None = None  # what it shows
        self._inside = False
        # what a filter of one's own prints meanwhile: nothing comes between the lines of the screen
        self.printed = StringIO()
        self._printed = 0  # how much of it is known to belong to a step, or has been shown
        self._said: dict[int, str] = {}  # what it has printed, by step

    def enter(self) -> None:
        """Take the terminal, at the start or again after Ctrl-Z."""
        self._inside, self._drawn_for = True, (0, 0)
        self.write(OTHER_SCREEN)

    def leave(self) -> None:
        """Give the terminal back."""
        if self._inside:
            self._inside = False
            self.write(self._removed() + OWN_SCREEN)

    def farewell(self) -> str:
        """What is to stay on the terminal: what was read of the run, as it was told."""
        numbers = sorted(self._read)[-LEFT:]
        return "".join(self._read[number] for number in numbers)

    def turn_to(self, scene: Scene, extent: Scope) -> None:
        """Another run comes in place of the one that was shown."""
        self._scene, self._extent, self._moment = scene, extent, None
        self._read, self._drawn_for, self._pictured = {}, (0, 0), None
        self.printed.seek(0)
        self.printed.truncate()
        self._printed, self._said = 0, {}
        if self.images is not None:
            self.images.turn_to(scene, extent)

    def show(self, moment: Moment) -> None:
        """Draw this in place of the last one."""
        last, self._moment = self._moment, moment
        if last is None or (last.view.number, last.page) != (moment.view.number, moment.page):
            self._scroll = None
        self._read[moment.view.number] = moment.narrative
        step = moment.view.step.entry.index
        made = () if moment.view.beam else range(step - moment.view.inputs + 1, step + 1)
        if said := "".join(self._said.get(index, "") for index in made) + self._unclaimed():
            lines = ["The filter has printed:", *said.splitlines()[-PRINTED:]]
            narrative = moment.narrative + "".join(f"{line}\n" for line in lines)
            self._moment = replace(moment, narrative=narrative)
        self._draw()

    def hear(self, step: int) -> None:
        """What the filter has printed until now it has printed in this step."""
        if said := self._unclaimed():
            self._said[step] = self._said.get(step, "") + said

    def _unclaimed(self) -> str:
        """What has been printed since it was last asked."""
        self.printed.seek(self._printed)
        said = self.printed.read()
        self._printed += len(said)
        return said

    def refresh(self) -> None:
        """Draw again where the terminal has another size, or was somebody else's."""
        if self._moment is not None and self._inside and self._drawn_for != self._now():
            self._drawn = []
            self._draw()

    def arrange(self, action: Action, count: int) -> str:
        """Turn to other panes, or scroll the numbers by half a screen."""
        if action is not Action.PANES:
            by = max(self._now()[1] // 4, 1) * count
            self._scroll = max(self._scrolled + (by if action is Action.DOWN else -by), 0)
            return ""
        turn = {Panes.BOTH: Panes.PICTURE, Panes.PICTURE: Panes.NUMBERS, Panes.NUMBERS: Panes.BOTH}
        self.panes, self._scroll = turn[self._what(self._now())], None
        return ""

    def wait(self, note: str) -> None:
        """Say in the status line how far a long way has come."""
        columns, rows = self._now()
        if self._inside:
            self.write(f"\x1b[{rows};1H{shorten(note, columns, self._look.ascii)}\x1b[K")
            self._drawn = self._drawn[: rows - 1]

    def _draw(self) -> None:
        assert self._moment is not None
        size = self._now()
        if not self._inside:
            return
        view = self._moment.view
        shown, first = self._extent.at(view), self._extent.base
        layout = Layout(
            self._scene, self._probability, _bounds(shown), _bounds(first), *size, self._look,
            imaged=self.images is not None,
        )  # fmt: skip
        panes = self._what(size)
        box = layout.box(self._moment, panes)
        if self.images is None or box is None or not self.images.fits(box):
            layout, box = replace(layout, imaged=False), None
        lines, self._scrolled = layout.lines(self._moment, panes, self._scroll)
        fresh = self._drawn_for != size or box != self._box
        changed = [
            f"\x1b[{row};1H{line}\x1b[K"
            for row, line in enumerate(lines, start=1)
            if fresh or row > len(self._drawn) or line != self._drawn[row - 1]
        ]
        self.write((self._removed() + CLEARED if fresh else "") + "".join(changed))
        self._drawn, self._drawn_for, self._box = lines, size, box
        if self.images is not None and box is not None and (fresh or view is not self._pictured):
            self.write(self.images.draw(view, box))
            self._pictured = view

    def _removed(self) -> str:
        """What takes the image away, and ends one of which a part was written."""
        return "" if self.images is None else END + self.images.removed()

    def _what(self, size: tuple[int, int]) -> Panes:
        if self.panes is not None:
            return self.panes
        return Panes.BOTH if ample(*size) else Panes.PICTURE

    def _now(self) -> tuple[int, int]:
        """Columns and rows that may be written on; the last column is left free."""
        columns, rows = self._size()
        return max(min(columns - 1, WIDEST), 1), max(min(rows, HIGHEST), 1)


def _bounds(limits: Limits) -> Bounds:
    return limits.left, limits.right, limits.bottom, limits.top
