import os
import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.backend_bases import ResizeEvent

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.look import SCREEN, STANDARD
from ekfsim.views.playback.playback import views
from ekfsim.views.terminal.interactive import play_interactively
from ekfsim.views.terminal.screens import window


@pytest.fixture(autouse=True)
def forget():
    window.backend.cache_clear()
    yield
    window.backend.cache_clear()


@pytest.mark.skipif(sys.platform in ("darwin", "win32"), reason="there is always a display")
def test_without_a_display_there_is_no_window(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert not window.available()


@pytest.mark.parametrize("name", ["agg", "nonsense"])
def test_a_backend_without_windows_opens_none(monkeypatch, name):
    monkeypatch.setenv("DISPLAY", ":1")
    monkeypatch.setenv("MPLBACKEND", name)
    assert not window.available()
    told = (
        f"MPLBACKEND names '{name}', which opens no window here; unset it, or --show text "
        f"draws in the terminal"
    )
    with pytest.raises(UsageError, match=f"^{told}$"):
        play_interactively(
            load_scene("square"), "window", Path("out"), STANDARD, force=False, explain=False
        )


def test_a_notebook_keeps_its_backend(tmp_path):
    told = "import ekfsim, os; ekfsim.draw; import matplotlib; print(matplotlib.get_backend())"
    environment = {**os.environ, "MPLBACKEND": "svg"}
    shown = subprocess.run(
        [sys.executable, "-c", told], capture_output=True, check=True, env=environment
    )
    assert shown.stdout == b"svg\n"


@pytest.mark.parametrize("outcome", ["aborts", "hangs"])
def test_a_toolkit_that_aborts_or_hangs_is_passed_over(monkeypatch, outcome):
    def run(arguments, **_):
        if outcome == "hangs":
            raise subprocess.TimeoutExpired(arguments, 20)
        return subprocess.CompletedProcess(arguments, -6)

    monkeypatch.setenv("DISPLAY", ":1")
    monkeypatch.delenv("MPLBACKEND", raising=False)
    monkeypatch.setattr(window, "find_spec", lambda module: True)
    monkeypatch.setattr(subprocess, "run", run)
    assert not window.available()


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("n", "n"),
        ("G", "G"),
        (" ", " "),
        ("space", " "),
        ("enter", "enter"),
        ("right", "right"),
        ("escape", "q"),
        ("ctrl+w", "q"),
        ("f1", "f1"),
        ("7", "7"),
        ("shift", None),
        (None, None),
    ],
)
def test_keys_go_by_the_terminals_names(name, key):
    assert window.key_of(name) == key


def test_it_fits_a_small_laptop_with_its_title_and_tool_bar():
    width, height = (side * SCREEN.dpi for side in window.SIZE)
    assert width <= 1366
    assert height + 50 + 40 <= 768 - 40  # tool bar, title, and the desktop's own bar


def test_another_size_divides_it_anew(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    run = load_scene("square")
    every = list(views(play(run)))
    shown = window.Window(run, scopes.of(run, play(run)))
    figure = shown._figure
    try:
        shown._shown = every[-1]
        before = figure.axes[0].get_position().bounds
        figure.set_size_inches(13.0, 5.9)
        figure.canvas.callbacks.process("resize_event", ResizeEvent("resize_event", figure.canvas))
        after = figure.axes[0].get_position().bounds
        assert after[2] < before[2]  # beside it stand the close-up, and the legend beside that
        legend, close = shown._picture.legend, figure.axes[1]
        assert legend.get_window_extent().x0 > close.get_window_extent().x1
    finally:
        shown.close()
