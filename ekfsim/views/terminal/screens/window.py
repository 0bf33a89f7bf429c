"""The picture in a window, where there is a display. The only place that knows pyplot."""

import os
import subprocess
import sys
from collections import deque
from functools import cache
from importlib.util import find_spec
from typing import Any

from matplotlib.backend_bases import Event, KeyEvent

from ekfsim.scene import Scene
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.frames import Picture
from ekfsim.views.picture.look import SCREEN, STANDARD, Look
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keys.bindings import Action
from ekfsim.views.terminal.keys.keyboard import NO_MORE
from ekfsim.views.terminal.screens.moment import Moment

BACKENDS = {  # matplotlib's, each with the modules of which it needs one
    "macosx": ("matplotlib.backends._macosx",),
    "qtagg": ("PySide6", "PyQt6", "PyQt5", "PySide2"),
    "gtk4agg": ("gi",),
    "gtk3agg": ("gi",),
    "tkagg": ("_tkinter",),
    "wxagg": ("wx",),
}
SIZE = (9.0, 6.1)  # inches: with title and tool bar it fits a screen of 1366 × 768
PATIENCE = 20  # s for a display to answer
LONGEST_WAIT = 0.05  # s between two looks for keys while a poll has no end
TRIAL = (
    "import sys; from matplotlib import pyplot as p; "
    "p.switch_backend(sys.argv[1]); p.figure().canvas.draw()"
)
NAMES = {  # keys that matplotlib calls by another name than the terminal's keyboard
    **dict.fromkeys(("space",), " "),
    **dict.fromkeys(("escape", "ctrl+c", "ctrl+w", "cmd+w", "ctrl+q", "cmd+q"), "q"),
}
MODIFIERS = ("shift", "control", "ctrl", "alt", "super", "cmd", "meta", "caps_lock", "num_lock")


def available() -> bool:
    """Whether a window can be opened: there is a display, and a toolkit that reaches it."""
    return backend() is not None


@cache
def backend() -> str | None:
    """The first of matplotlib's backends that opens a window here.

    Each is tried in a process of its own, because a toolkit may abort, or wait for ever, where its
    display is broken.
    """
    if sys.platform not in ("darwin", "win32") and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    ):
        return None
    wanted = os.environ.get("MPLBACKEND", "").lower()
    return next(filter(_opens, [wanted] if wanted else BACKENDS), None)


def _opens(name: str) -> bool:
    if not any(find_spec(module) for module in BACKENDS.get(name, ())):
        return False
    try:
        trial = subprocess.run(
            [sys.executable, "-c", TRIAL, name], capture_output=True, timeout=PATIENCE, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return trial.returncode == 0


class Window:
    """A window with the picture of a view;
    keys pressed in it are handed on as those of the terminal are.
    """

    keeps = False

    def __init__(self, scene: Scene, scope: Scope, look: Look = STANDARD) -> None:
        from matplotlib import pyplot, rcParams

        pyplot.switch_backend(backend() or "agg")
        for name in list(rcParams):
            if name.startswith("keymap."):  # n, p, q, s, r and the arrows are ours
                rcParams[name] = []
        self._pressed: deque[str] = deque()
        self.closed = False
        self._name = f"ekfsim: {scene.world.name}"
        self._figure = pyplot.figure(num=self._name, figsize=SIZE, dpi=SCREEN.dpi)
        self._canvas: Any = self._figure.canvas  # matplotlib leaves most of its methods untyped
        self._look = look
        self._picture = Picture(self._figure, scene, scope, look)
        self._canvas.mpl_connect("key_press_event", self._press)
        self._canvas.mpl_connect("close_event", self._close)
        self._canvas.mpl_connect("resize_event", self._resize)
        self._shown: View | None = None
        pyplot.show(block=False)

    def turn_to(self, scene: Scene, scope: Scope) -> None:
        """The next views are of this scene."""
        if not self.closed:
            self._figure.clear()
            self._shown, self._picture = None, Picture(self._figure, scene, scope, self._look)

    def show(self, moment: Moment) -> None:
        """Show a view, and do not wait."""
        if self.closed:
            return
        self._shown = moment.view
        self._picture.show(moment.view)
        self._say((moment.note or moment.page_name or moment.place).split("\n")[0])
        self._canvas.draw_idle()
        self._canvas.flush_events()

    def arrange(self, action: Action, count: int) -> str:
        """There is nothing to arrange."""
        return "The picture is in the window, the numbers are in the terminal"

    def wait(self, note: str) -> None:
        """Say it in the window's frame."""
        self._say(note)
        self._canvas.flush_events()

    def close(self) -> None:
        """Take it away."""
        from matplotlib import pyplot

        pyplot.close(self._figure)

    def _say(self, what: str) -> None:
        """Say it in the window's frame, beside the name of the world."""
        self._canvas.manager.set_window_title(f"{self._name}: {what}")

    def poll(self, timeout: float | None = None) -> str | None:
        """The next key, or None where none is pressed for `timeout` s.
        Closing the window asks to quit.
        """
        waited = 0.0
        while not self._pressed and not self.closed and (timeout is None or waited < timeout):
            wait = LONGEST_WAIT if timeout is None else min(LONGEST_WAIT, timeout - waited)
            self._canvas.start_event_loop(max(wait, 0.001))
            waited += wait
        if self._pressed:
            return self._pressed.popleft()
        return NO_MORE if self.closed else None

    def _resize(self, event: Event) -> None:
        """Divide the window anew."""
        self._picture.arrange()
        if self._shown is not None:
            self._picture.show(self._shown)

    def _press(self, event: Event) -> None:
        assert isinstance(event, KeyEvent)
        key = key_of(event.key)
        if key is not None:
            self._pressed.append(key)
            self._canvas.stop_event_loop()

    def _close(self, event: Event) -> None:
        self.closed = True
        self._canvas.stop_event_loop()


def key_of(name: str | None) -> str | None:
    """What the terminal's keyboard calls the key of this name; None for a modifier alone.

    >>> key_of("n"), key_of("right"), key_of("7"), key_of("shift"), key_of("escape")
    ('n', 'right', '7', None, 'q')
    """
    return None if not name or name in MODIFIERS else NAMES.get(name, name)
