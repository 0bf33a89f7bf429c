"""Puts an interactive run together:
keys from the terminal and the window, pictures on the screen that there is.
"""

import itertools
import os
import shutil
import sys
from collections.abc import Callable
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from ekfsim.errors import EkfsimError, UsageError
from ekfsim.files.results.writing import whole_file
from ekfsim.files.yaml.telling import quoted
from ekfsim.localization import play
from ekfsim.provenance import metadata
from ekfsim.scene import Scene
from ekfsim.views.picture import limits
from ekfsim.views.picture.limits import Limits
from ekfsim.views.picture.look import Look, get_ready
from ekfsim.views.playback.playback import UntilFailure
from ekfsim.views.playback.view import View
from ekfsim.views.terminal import drawing as terminal
from ekfsim.views.terminal.keyboard import Key, Keyboard, keys
from ekfsim.views.terminal.player import Player, Screen

if TYPE_CHECKING:
    from ekfsim.views.picture.frames import Frame
    from ekfsim.views.terminal.window import Window

# steps whose limits are known before the first picture; where a later one leaves them it grows
LOOK_AHEAD = 3000
POLL = 0.05  # s between two looks at the window while no key is pressed
MARGIN = 2  # rows of the terminal left free of the picture
WIDEST, HIGHEST = 1000, 300  # columns and rows of a picture, whatever COLUMNS and LINES say


def play_interactively(
    scene: Scene, show: str, out: Path, look: Look, force: bool, explain: bool
) -> None:
    """Step through a scene until a key quits. show : auto, window, text or files;
    out : folder of saved pictures; explain : the narrative in its long form

    Raises UsageError where a window is asked for and there is none.
    """
    window_wanted = show == "window" or (show == "auto" and _window_available())
    if show == "window" and not _window_available():
        raise UsageError(_why_no_window())
    ahead = (UntilFailure(itertools.islice(play(one), LOOK_AHEAD)) for one in scene.alone())
    with redirect_stderr(StringIO()):  # what a filter prints it prints again as it is watched
        extent = limits.of_all(scene, ahead, look.probability)
    pictures = Pictures(scene, extent, look, out, force)
    window: Window | None = None
    screen: Screen
    if window_wanted:
        from ekfsim.views.terminal import window as windows

        screen = window = windows.Window(scene, extent, look)
    elif show == "files":
        screen = pictures
    else:
        screen = Text(scene, extent, look.probability, sys.stdout)
    with keys() as keyboard:
        player = Player(
            scene, play(scene), screen, pictures.save, sys.stdout, look.probability, explain
        )
        player.play(keyboard if window is None else _either(keyboard, window))


def _display() -> bool:
    displays = ("DISPLAY", "WAYLAND_DISPLAY")
    return sys.platform in ("darwin", "win32") or any(os.environ.get(name) for name in displays)


def _window_available() -> bool:
    if not _display():
        return False  # without the second that it takes to import matplotlib
    get_ready()
    from ekfsim.views.terminal.window import available

    return available()


def _why_no_window() -> str:
    """Why no window can be opened, and the way out."""
    wanted = os.environ.get("MPLBACKEND")
    if wanted and _display():
        told = f"MPLBACKEND names {quoted(wanted)}, which opens no window here"
        return f"{told}; unset it, or --show text draws in the terminal"
    return "there is no display to open a window on; --show text draws in the terminal"


def _either(keyboard: Keyboard, window: "Window") -> Callable[[], Key]:
    """The next key, pressed in the terminal or in the window."""

    def next_key() -> Key:
        while True:
            key = window.poll(POLL)
            if key is None:
                key = keyboard(0.0)
            if key is not None:
                return key

    return next_key


class Text:
    """Draws each view below the narrative, in characters."""

    def __init__(self, scene: Scene, extent: Limits, probability: float, out: TextIO) -> None:
        self._scene, self._extent, self._probability, self._out = scene, extent, probability, out
        coloured = (
            out.isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"
        )
        self._colour, self._ascii = coloured, not _can_print("⠿", out)

    def show(self, view: View) -> None:
        """Print the picture of a view, as large as the terminal allows."""
        columns, rows = shutil.get_terminal_size()
        e = self._extent
        picture = terminal.draw(
            view, self._scene, self._probability, (min(columns - 1, WIDEST), min(rows - MARGIN,
            HIGHEST)),
            (e.left, e.right, e.bottom, e.top), self._colour, self._ascii,
        )  # fmt: skip
        self._out.write(f"{picture}\n\n")
        self._out.flush()


class Pictures:
    """Writes pictures to files: one that is rewritten for every view, and those that are saved."""

    def __init__(self, scene: Scene, extent: Limits, look: Look, out: Path, force: bool) -> None:
        self._scene, self._extent, self._look, self._out, self._force = (
            scene,
            extent,
            look,
            out,
            force,
        )
        self._frame: Frame | None = None

    def show(self, view: View) -> None:
        """Rewrite the current picture in place."""
        self._write(view, self._out / "current.png", force=True)

    def save(self, view: View) -> str:
        """Save the picture of a view under its number, beside those saved of it before;
        says where, or why not.
        """
        path = self._out / f"view-{view.number:04}.png"
        for again in itertools.count(2):
            if self._force or not os.path.lexists(path):
                break
            path = self._out / f"view-{view.number:04}-{again}.png"
        try:
            self._write(view, path, self._force)
        except EkfsimError as refusal:
            return str(refusal)
        return f"Saved {path}"

    def _write(self, view: View, path: Path, force: bool) -> None:
        if self._frame is None:
            get_ready()
            from ekfsim.views.picture.frames import Frame

            self._frame = Frame(self._scene, self._extent, self._look)
        with whole_file(path, force) as beside:
            beside.write_bytes(self._frame.png(view, metadata(self._scene)))


def _can_print(text: str, out: TextIO) -> bool:
    try:
        text.encode(out.encoding or "utf-8")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
