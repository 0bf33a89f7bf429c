"""What an interactive run is seen on and heard from: the screens that there are, and their keys."""

import math
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, redirect_stderr
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from ekfsim.errors import StepError, UsageError
from ekfsim.files.yaml.telling import quoted
from ekfsim.scene import Scene
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.look import Look, get_ready
from ekfsim.views.playback.kept import nobody
from ekfsim.views.playback.view import View
from ekfsim.views.terminal import drawing as terminal
from ekfsim.views.terminal.images.asking import Means, ask
from ekfsim.views.terminal.images.images import Images
from ekfsim.views.terminal.keys.interrupts import noticed, unnoticed
from ekfsim.views.terminal.keys.keyboard import Keyboard, keys
from ekfsim.views.terminal.keys.sources import pixels
from ekfsim.views.terminal.screens import layout
from ekfsim.views.terminal.screens.console import Console
from ekfsim.views.terminal.screens.files import Pictures
from ekfsim.views.terminal.screens.layout import Panes
from ekfsim.views.terminal.screens.moment import Screen, Together
from ekfsim.views.terminal.screens.stream import Stream

if TYPE_CHECKING:
    from ekfsim.views.terminal.screens.window import Window

POLL = 0.05  # s between two looks at the window while no key is pressed
RESIZED = 0.2  # s between two looks at the size of the terminal
# rows of the terminal left free of the picture, and one more for the hint on the keys
MARGIN = 2
WIDEST, HIGHEST = 1000, 300  # columns and rows of a picture, whatever COLUMNS and LINES say
NO_TERMINAL = (
    "--show image draws in a terminal, and this is none that can be drawn on; --show files draws "
    "into a file"
)
NO_IMAGES = (
    "this terminal does not say that it draws images as kitty or iTerm2 do, or sixels; --show text "
    "draws with letters"
)
NextKey = Callable[[float | None], str | None]


def wants_window(show: str) -> bool:
    """Whether a window is to be opened. show : auto, window, image, text or files

    Raises UsageError where a window or an image is asked for, and there is no place for it.
    """
    if show == "image" and not _in_place():
        raise UsageError(NO_TERMINAL)
    wanted = show == "window" or (show == "auto" and _window_available())
    if show == "window" and not _window_available():
        raise UsageError(_why_no_window())
    return wanted


def wants_watching() -> None:
    """Raises UsageError where nobody could see what was saved."""
    if not _in_place():
        raise UsageError(
            "--watch shows what is saved to whoever sits before a terminal that can be drawn on, "
            "and there is none; leave it out"
        )


@dataclass
class Stage:
    """The screens of one run, and the keys pressed before them."""

    screen: Screen
    pictures: Pictures
    console: Console | None
    window: "Window | None"
    images: Callable[[Means], Images] | None  # on the terminal, where it can draw them
    required: bool  # whether nothing will do in their place

    @classmethod
    def of(
        cls, scene: Scene, extent: Scope, show: str, out: Path, look: Look, force: bool = False
    ) -> "Stage":
        """Those that are asked for. out : folder of saved pictures

        Raises UsageError where a window is asked for and there is none.
        """
        pictures = Pictures(scene, extent, look, out, force)
        window: Window | None = None
        screens: list[Screen] = []
        if wants_window(show):
            from ekfsim.views.terminal.screens import window as windows

            window = windows.Window(scene, extent, look)
            screens = [window]
        elif show == "files":
            screens = [pictures]
        console = _console(scene, extent, look) if _in_place() else None
        if console is not None:
            told: Screen = console
            console.panes = Panes.NUMBERS if screens else None
        else:
            drawn = None if screens else partial(_drawn, scene, extent, look.probability)
            told = Stream(sys.stdout, drawn, hinting=_somebody())
        wanted = show == "image" or (show == "auto" and window is None and console is not None)
        images = partial(Images, scene, extent, look) if wanted else None
        return cls(Together([told, *screens]), pictures, console, window, images, show == "image")

    def turn_to(self, scene: Scene, extent: Scope) -> None:
        """Another run comes in place of the one that was shown."""
        for screen in (self.console, self.window, self.pictures):
            if screen is not None:
                screen.turn_to(scene, extent)

    @property
    def interruptible(self) -> Callable[[], AbstractContextManager[Callable[[], bool]]]:
        """A block in which Ctrl-C stops what takes long, and not the program."""
        return unnoticed if self.console is None else noticed

    @property
    def hear(self) -> Callable[[int], None]:
        """Is told of each step as it is made."""
        return nobody if self.console is None else self.console.hear

    @contextmanager
    def keys(self) -> Iterator[NextKey]:
        """The keys; what was read of the run stays on the terminal when it is left.

        Raises UsageError where images are asked for, and the terminal does not say that it draws
        them.
        """
        try:
            with _typed(self.console) as keyboard:
                if self.console is not None and self.images is not None:
                    self._ask(keyboard, self.console, self.images)
                yield partial(_next_key, keyboard, self.window, self.console)
        finally:
            if self.window is not None:
                self.window.close()

    def _ask(self, keyboard: Keyboard, console: Console, images: Callable[[Means], Images]) -> None:
        """Draw images, if the terminal says that it can."""
        size = shutil.get_terminal_size()
        asking = partial(ask, write=console.write, size=size, pixels=pixels(sys.stdout))
        means = keyboard.lend(asking)
        if means is not None:
            console.images = images(means)
        elif self.required:
            raise UsageError(NO_IMAGES)


@contextmanager
def _typed(console: Console | None) -> Iterator[Keyboard]:
    """The keyboard; what was read of the run stays on the terminal when it is left."""
    if console is None:
        with keys() as keyboard:
            yield keyboard
        return
    over = False
    try:
        with redirect_stderr(console.printed), keys(drawn=console) as keyboard:
            yield keyboard
        over = True
    except (KeyboardInterrupt, StepError):
        over = True
        raise
    finally:
        sys.stderr.write(console.printed.getvalue())
        if over:
            sys.stdout.write(console.farewell())


def _next_key(
    keyboard: Keyboard, window: "Window | None", console: Console | None, timeout: float | None
) -> str | None:
    """The next key, pressed in the terminal or in the window; None where none is in that time."""
    deadline = math.inf if timeout is None else time.monotonic() + timeout
    while True:
        left = max(0.0, deadline - time.monotonic())
        if window is not None:
            name = window.poll(min(POLL, left))
            name = keyboard(0.0) if name is None else name
        elif console is not None:
            name = keyboard(min(RESIZED, left))
            console.refresh()
        else:
            name = keyboard(None if left == math.inf else left)
        if name is not None or left <= 0:
            return name


def _console(scene: Scene, extent: Scope, look: Look) -> Console:
    out = sys.stdout
    encoding = out.encoding or "utf-8"

    def write(text: str) -> None:
        """Past all buffers: a signal may come while one is written."""
        left = text.encode(encoding, "replace")
        while left:
            left = left[os.write(out.fileno(), left) :]

    out.flush()
    means = layout.Look("NO_COLOR" not in os.environ, not _can_print("⠿", out))
    return Console(scene, extent, look.probability, means, write)


def _drawn(scene: Scene, extent: Scope, probability: float, view: View) -> str:
    """The picture of a view in characters, as large as the terminal allows."""
    columns, rows = shutil.get_terminal_size()
    e, size = extent.at(view), (min(columns - 1, WIDEST), min(rows - MARGIN - _somebody(), HIGHEST))
    coloured = sys.stdout.isatty() and not {"NO_COLOR"} & set(os.environ)
    coloured = coloured and os.environ.get("TERM") != "dumb"
    bounds = e.left, e.right, e.bottom, e.top
    ascii = not _can_print("⠿", sys.stdout)
    return terminal.draw(view, scene, probability, size, bounds, coloured, ascii)


def _somebody() -> bool:
    """Whether somebody sits before it."""
    return sys.stdin.isatty() and sys.stdout.isatty()


def _in_place() -> bool:
    """Whether somebody sits before a terminal that can be drawn on in place."""
    return _somebody() and os.environ.get("TERM", "dumb") != "dumb"


def _display() -> bool:
    displays = ("DISPLAY", "WAYLAND_DISPLAY")
    return sys.platform in ("darwin", "win32") or any(os.environ.get(name) for name in displays)


def _window_available() -> bool:
    if not _display():
        return False  # without the second that it takes to import matplotlib
    get_ready()
    from ekfsim.views.terminal.screens.window import available

    return available()


def _why_no_window() -> str:
    """Why no window can be opened, and the way out."""
    wanted = os.environ.get("MPLBACKEND")
    if wanted and _display():
        told = f"MPLBACKEND names {quoted(wanted)}, which opens no window here"
        return f"{told}; unset it, or --show text draws in the terminal"
    return "there is no display to open a window on; --show text draws in the terminal"


def _can_print(text: str, out: TextIO) -> bool:
    try:
        text.encode(out.encoding or "utf-8")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
