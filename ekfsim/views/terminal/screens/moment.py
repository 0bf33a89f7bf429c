"""What is to be seen after a key was pressed, and what a screen is asked to do with it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keys.bindings import Action

HINTS = "n next", "? keys", "p back", "q quit"


@dataclass(frozen=True, slots=True)
class Moment:
    """All that is to be seen after a key was pressed."""

    view: View
    narrative: str  # of the view, and after the last one the verdict
    place: str  # "step 13 of 80, view 22 of 145"
    explained: bool = False  # whether that is its long form
    before: str = ""  # what the other view of the same step has told
    # what a screen that keeps everything tells first: what was passed by, or whither it went
    passed: str = ""
    note: str = ""  # what there is to say of the key
    page: str = ""  # what was asked for in place of the run, until the next key: the help
    page_name: str = ""  # what that is called, where it is not the help
    typed: int = 0  # the number that is being typed, 0 where none is
    hints: tuple[str, ...] = HINTS  # the keys to know, those most needed first


class Screen(Protocol):
    """Where an interactive run is seen."""

    keeps: bool  # what it has shown: all that is told stays there to be read

    def show(self, moment: Moment) -> None:
        """Draw this in place of the last one."""

    def arrange(self, action: Action, count: int) -> str:
        """Turn to other panes, or scroll; says what there is to say of it."""

    def wait(self, note: str) -> None:
        """Say how far a long way has come."""


class Together:
    """Several screens at once, as a terminal and a window."""

    def __init__(self, screens: Sequence[Screen]) -> None:
        self._screens = screens
        self.keeps = any(screen.keeps for screen in screens)

    def show(self, moment: Moment) -> None:
        """Draw this on each of them."""
        for screen in self._screens:
            screen.show(moment)

    def arrange(self, action: Action, count: int) -> str:
        """Ask all, and say what the first of them has to say."""
        said = [screen.arrange(action, count) for screen in self._screens]
        return said[0]

    def wait(self, note: str) -> None:
        """Say it on each."""
        for screen in self._screens:
            screen.wait(note)
