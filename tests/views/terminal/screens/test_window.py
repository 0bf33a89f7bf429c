import os
import subprocess
import sys
from pathlib import Path

import pytest

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.views.picture.look import STANDARD
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
