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
from ekfsim.views.picture.frames import DPI, INCHES, Picture
from ekfsim.views.picture.limits import Limits
from ekfsim.views.picture.look import STANDARD, Look
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keyboard import CHARACTERS, Action, Key

BACKENDS = {  # matplotlib's, each with the modules of which it needs one
    "macosx": ("matplotlib.backends._macosx",),
    "qtagg": ("PySide6", "PyQt6", "PyQt5", "PySide2"),
    "gtk4agg": ("gi",),
    "gtk3agg": ("gi",),
    "tkagg": ("_tkinter",),
    "wxagg": ("wx",),
}
PATIENCE = 20  # s for a display to answer
LONGEST_WAIT = 0.05  # s between two looks for keys while a poll has no end
TRIAL = (
    "import sys; from matplotlib import pyplot as p; "
    "p.switch_backend(sys.argv[1]); p.figure().canvas.draw()"
)
NAMES: dict[str, Key] = {  # keys that write no character, as matplotlib calls them
    **dict.fromkeys(("right", "down", "pagedown", "enter", "space"), Action.NEXT),
    **dict.fromkeys(("left", "up", "pageup", "backspace", "delete"), Action.BACK),
    **dict.fromkeys(
        ("escape", "ctrl+d", "ctrl+c", "ctrl+w", "cmd+w", "ctrl+q", "cmd+q"), Action.QUIT
    ),
    "f1": Action.HELP,
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

    def __init__(self, scene: Scene, limits: Limits, look: Look = STANDARD) -> None:
        from matplotlib import pyplot, rcParams

        pyplot.switch_backend(backend() or "agg")
        for name in list(rcParams):
            if name.startswith("keymap."):  # n, p, q, s, r and the arrows are ours
                rcParams[name] = []
        self._pressed: deque[Key] = deque()
        self.closed = False
        self._figure = pyplot.figure(num=f"ekfsim: {scene.world.name}", figsize=INCHES, dpi=DPI)
        self._canvas: Any = self._figure.canvas  # matplotlib leaves most of its methods untyped
        self._picture = Picture(self._figure, scene, limits, look)
        self._canvas.mpl_connect("key_press_event", self._press)
        self._canvas.mpl_connect("close_event", self._close)
        self._picture.label()
        pyplot.show(block=False)

    def show(self, view: View) -> None:
        """Show a view, and do not wait."""
        if self.closed:
            return
        if self._picture.show(view):
            self._picture.label()
        self._canvas.draw_idle()
        self._canvas.flush_events()

    def poll(self, timeout: float | None = None) -> Key | None:
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
        return Action.QUIT if self.closed else None

    def _press(self, event: Event) -> None:
        assert isinstance(event, KeyEvent)
        key = key_of(event.key)
        if key is not None:
            self._pressed.append(key)
            self._canvas.stop_event_loop()

    def _close(self, event: Event) -> None:
        self.closed = True
        self._canvas.stop_event_loop()


def key_of(name: str | None) -> Key | None:
    """The key that matplotlib gives this name; None for a modifier alone.

    >>> key_of("n"), key_of("right"), key_of("7"), key_of("shift"), key_of("x")
    (<Action.NEXT: 'next'>, <Action.NEXT: 'next'>, 7, None, <Action.UNKNOWN: 'unknown'>)
    """
    if not name or name in MODIFIERS:
        return None
    return NAMES.get(name) or CHARACTERS.get(name.lower(), Action.UNKNOWN)
