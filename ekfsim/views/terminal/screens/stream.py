"""A run told from top to bottom, for a pipe, a file and a terminal that cannot do more."""

from collections.abc import Callable
from typing import TextIO

from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keys.bindings import Action
from ekfsim.views.terminal.screens.moment import Moment


class Stream:
    """Writes what is new below what stands there: narrative, picture, and what there is to say."""

    keeps = True

    def __init__(
        self, out: TextIO, picture: Callable[[View], str] | None, hinting: bool = False
    ) -> None:
        self._out, self._picture = out, picture
        self._hinting = hinting  # whether somebody sits before it who may want to know the keys
        self._shown: Moment | None = None

    def show(self, moment: Moment) -> None:
        """Write what is new: of another view all of it, of the same what is said of the key."""
        last, self._shown = self._shown, moment
        moved = last is None or moment.view.number != last.view.number
        if moment.page and not (last and last.page):
            self._out.write(f"{moment.page}\n")
        if moment.note and not moved:
            self._out.write(f"{moment.note}\n")
        if last is None or moved or moment.explained != last.explained:
            self._out.write(moment.passed + moment.narrative)
        if moved and self._picture is not None:
            self._out.write(f"{self._picture(moment.view)}\n\n")
        if moved and moment.note:
            self._out.write(f"{moment.note}\n")
        elif moved and self._hinting:
            self._out.write(f"{moment.place}: {', '.join(moment.hints[:2])}\n")
        self._out.flush()

    def arrange(self, action: Action, count: int) -> str:
        """There is nothing to arrange."""
        return "Picture and numbers stand one below the other here"

    def wait(self, note: str) -> None:
        """Nothing: what is on the way is no result."""
