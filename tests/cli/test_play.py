"""play: keys from a pipe and from a terminal, pictures in characters and in files."""

import base64
import os
import re
import select
import signal
import struct
import subprocess
import sys
import time
from contextlib import suppress

import pytest
from program import (
    LONG,
    PATIENCE,
    SHORT,
    WORLD,
    ekfsim,
    ended,
    lay_out,
    left_in,
    process,
    started,
    wait_for,
)

from ekfsim.views.film.png import SIGNATURE

if sys.platform == "win32":
    pytest.skip("the terminals of this test are POSIX ones", allow_module_level=True)

import fcntl
import termios

PUT_IN = ["long.yaml", "short.yaml", "world.yaml"]
OVER = "The run is over: q quits, p goes back, r starts again"
START = "This is the start: n goes on, q quits"
PICTURE = re.compile("[\u2800-\u28ff]")


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "COLUMNS", "LINES", "NO_COLOR"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def told(keys, *args, show="text"):
    """What is said when these keys come through a pipe."""
    played = ekfsim("play", "short.yaml", "--show", show, *args, keys=keys)
    assert (played.status, played.err) == (0, "")
    return played.out


def commands_told(keys):
    return told(keys).count("\n==>")


@pytest.mark.parametrize(
    ("keys", "commands"),
    [
        (b"", 0),
        (b"q", 0),
        (b"nq", 1),
        (b"nnnnq", 3),
        (b"nnnn", 3),
        (b"12nq", 3),
        (b"2nq", 2),
        (b"n\n\nq", 1),
        (b"qn", 0),
    ],
)
def test_each_n_of_a_pipe_is_a_view_and_its_end_quits(keys, commands):
    assert commands_told(keys) == commands


def test_keys_may_come_from_dev_null_and_from_nowhere():
    for source in ("</dev/null", "<&-"):
        assert process("play", "short.yaml", "--show", "text", after=source).out == told(b"")


def test_the_whole_of_it_is_the_narrative_of_run():
    lines = [line for line in told(b"4n").splitlines() if not PICTURE.search(line)]
    narrative = [line for line in ekfsim("run", "short.yaml").out.splitlines() if line]
    assert [line for line in lines if line in narrative] == narrative


def test_beyond_the_end_it_says_so_and_before_the_start_it_stays():
    assert told(b"9n").count(OVER) == 0
    assert told(b"9nnnnn").count(OVER) == 1
    assert told(b"9nnnpnnn").count(OVER) == 2
    assert told(b"p99pn3p99pp").count(START) == 3  # a number in between asks anew
    assert told(b"p99pn3p99pp").count("<==Back at step 0 of 3, view 0 of 4\n") == 1


def test_back_and_forth_and_from_the_start():
    said = told(b"nnpnr")
    assert "<==Back at step 1 of 3, view 1 of 4\n" in said
    assert "<==Back at step 0 of 3, view 0 of 4\n" in said
    assert said.count("==>Commanding") == 2
    assert said.count("==>The robot moved") == 2  # told again as it comes back to it


def test_help_and_unknown_keys():
    assert "12n: twelve" in told(b"?")
    assert "That key does nothing here; ? shows those that do\n" in told(b"x")
    assert told(b"\xff\xfe\x00\x1b[99~z").count("That key does nothing here") >= 3


def test_s_saves_a_picture_and_never_over_another(place):
    said = told(b"nsss", "--out", "a/b")
    saved = ["step-0001.png", "step-0001-2.png", "step-0001-3.png"]
    assert [line for line in said.splitlines() if line.startswith("Saved")] == [
        f"Saved a/b/{name}" for name in saved
    ]
    assert sorted(left_in(place / "a/b")) == sorted(saved)
    picture = (place / "a/b/step-0001.png").read_bytes()
    assert picture.startswith(SIGNATURE)
    assert told(b"nss", "--out", "a/b", "--force").count("Saved a/b/step-0001.png\n") == 2
    assert (place / "a/b/step-0001.png").read_bytes() == picture


def test_a_picture_that_cannot_be_saved_ends_nothing(place):
    said = told(b"snn", "--out", "world.yaml")
    assert "world.yaml/step-0000.png: 'world.yaml' is no folder\n" in said
    assert said.count("\n==>") == 2
    assert left_in(place) == PUT_IN


def test_files_rewrite_one_picture(place):
    (place / "out").mkdir()
    (place / "out/current.png").write_bytes(b"older")
    told(b"", show="files")
    first = (place / "out/current.png").read_bytes()
    told(b"nn", show="files")
    second = (place / "out/current.png").read_bytes()
    assert first.startswith(SIGNATURE)
    assert second.startswith(SIGNATURE)
    assert first != second
    assert left_in(place) == ["long.yaml", "out", "out/current.png", "short.yaml", "world.yaml"]
    assert not PICTURE.search(told(b"n", show="files"))


def test_the_picture_in_a_file_is_whole_at_every_moment(place):
    (place / "long.yaml").write_text(LONG.replace("20000", "200"))
    running = started("play", "long.yaml", "--show", "files", stdin=subprocess.PIPE)
    running.stdin.write(b"n" * 500)
    running.stdin.flush()
    seen = set()

    def looked_at_often():
        if (place / "out/current.png").exists():
            picture = (place / "out/current.png").read_bytes()
            assert picture.startswith(SIGNATURE)
            assert picture.endswith(b"IEND\xaeB`\x82")
            seen.add(picture)
        return len(seen) > 5

    wait_for(looked_at_often, running)
    running.send_signal(signal.SIGTERM)
    assert ended(running).status == 143
    assert left_in(place) == ["long.yaml", "out", "out/current.png", "short.yaml", "world.yaml"]


def test_files_where_none_can_be(place):
    played = ekfsim("play", "short.yaml", "--show", "files", "--out", "world.yaml")
    assert played.status == 2
    assert played.err == "ekfsim: world.yaml/current.png: 'world.yaml' is no folder\n"


def test_a_window_without_a_display():
    played = ekfsim("play", "short.yaml", "--show", "window")
    assert (played.status, played.out) == (2, "")
    assert (
        played.err
        == "ekfsim: there is no display to open a window on; --show text draws in the terminal\n"
    )


def test_auto_without_a_display_draws_characters_without_colours():
    assert told(b"n", show="auto") == told(b"n", show="text")
    assert PICTURE.search(told(b"n", show="auto"))
    assert "\x1b" not in told(b"n", show="auto")


def test_ascii_where_braille_cannot_be_printed():
    played = process("play", "short.yaml", "--show", "text", keys=b"n", PYTHONIOENCODING="ascii")
    assert (played.status, played.err) == (0, "")
    assert played.out.isascii()
    assert "####" in played.out


@pytest.mark.parametrize(
    ("columns", "lines"),
    [("20", "5"), ("1", "1"), ("0", "0"), ("-3", "x"), ("", ""), ("999999999", "999999999")],
)
def test_any_size_of_the_terminal_is_lived_with(monkeypatch, columns, lines):
    monkeypatch.setenv("COLUMNS", columns)
    monkeypatch.setenv("LINES", lines)
    shown = told(b"n")
    assert shown.count("\n==>") == 1
    assert len(shown) < 1_000_000
    if columns in ("20", "1"):
        assert max(
            len(line) for line in shown.splitlines() if PICTURE.search(line) or "…" in line
        ) <= int(columns)


def test_a_reader_who_has_seen_enough_is_no_failure(place):
    (place / "long.yaml").write_text(LONG.replace("20000", "50"))
    after = '| head -1; exit "${PIPESTATUS[0]}"'
    played = process("play", "long.yaml", "--show", "text", keys=b"n" * 100, after=after)
    assert (played.status, played.err) == (0, "")
    assert len(played.out.splitlines()) == 1


class Terminal:
    """A terminal with the program in it."""

    def __init__(self, *args, columns=80, rows=24, **environment):
        self.ours, self.its = os.openpty()
        fcntl.ioctl(self.its, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        os.set_blocking(self.ours, False)
        self.settings = termios.tcgetattr(self.its)
        self.shown = ""
        self.running = started(
            *args, stdin=self.its, stdout=self.its, stderr=self.its, start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0), env={**os.environ,
            "TERM": "xterm", **environment},
        )  # fmt: skip

    def press(self, keys):
        os.write(self.ours, keys)

    def read(self):
        with suppress(OSError):  # nothing there yet
            self.shown += os.read(self.ours, 1 << 16).decode(errors="replace")
        return self.shown

    def wait_for(self, text):
        wait_for(lambda: text in self.read(), self.running)

    def status(self):
        """How it ended; by then the terminal is as it was."""
        try:
            deadline = time.monotonic() + PATIENCE
            while self.running.poll() is None and time.monotonic() < deadline:
                select.select([self.ours], [], [], 0.01)
                self.read()
            self.read()
            assert termios.tcgetattr(self.its) == self.settings
        finally:
            self.running.kill()
            os.close(self.ours)
            os.close(self.its)
        return self.running.returncode


def pictured(shown):
    return [line for line in shown.splitlines() if PICTURE.search(line)]


def test_keys_typed_ahead_in_a_terminal_wait_their_turn():
    terminal = Terminal("play", "short.yaml", "--show", "auto")
    terminal.press(b"nn?q")
    assert terminal.status() == 0
    assert "12n: twelve" in terminal.shown
    left = terminal.shown.split("\x1b[?1049l")[-1]  # what stays on the terminal
    assert left.count("\n==>") == 2
    assert "\x1b" not in left


def test_a_small_terminal_without_colours():
    terminal = Terminal(
        "play", "short.yaml", "--show", "text", columns=20, rows=5, NO_COLOR="1", TERM="dumb"
    )
    terminal.press(b"nq")
    assert terminal.status() == 0
    assert "\x1b" not in terminal.shown
    assert max(map(len, pictured(terminal.shown))) <= 20


@pytest.mark.parametrize(("ending", "status"), [("key", 130), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_a_terminal_is_put_back_however_it_ends(ending, status):
    terminal = Terminal("play", "short.yaml", "--show", "text")
    terminal.press(b"n")
    terminal.wait_for("view 1 of 4")
    if ending == "key":
        terminal.press(b"\x03")
    else:
        terminal.running.send_signal(getattr(signal, ending))
    assert terminal.status() == status
    assert "Traceback" not in terminal.shown
    assert terminal.shown.count("\x1b[?1049h") == terminal.shown.count("\x1b[?1049l") == 1
    assert terminal.shown.rindex("\x1b[?25h") > terminal.shown.rindex("\x1b[?25l")


def test_a_terminal_that_draws_images_gets_the_pictures():
    terminal = Terminal("play", "short.yaml", "--show", "image")
    terminal.press(b"n")
    terminal.wait_for("\x1b[c")  # the last of the questions
    terminal.press(b"\x1b_Gi=1;OK\x1b\\n\x1b[6;16;8t\x1b[?62;cnq")
    assert terminal.status() == 0
    images = re.findall("\x1b_Ga=T,([^;]*);([^\x1b]*)", terminal.shown)
    assert len(images) == 4
    assert all("c=79,r=23" in keys for keys, _ in images)
    assert all(base64.b64decode(begun).startswith(SIGNATURE) for _, begun in images)
    assert terminal.shown.rindex("\x1b_Ga=d") < terminal.shown.rindex("\x1b[?1049l")
    assert not pictured(terminal.shown)


def test_a_terminal_that_draws_none_is_told_from_one_that_does():
    terminal = Terminal("play", "short.yaml", "--show", "image")
    terminal.wait_for("\x1b[c")
    terminal.press(b"\x1b[?1;2c")
    assert terminal.status() == 2
    left = " ".join(terminal.shown.split("\x1b[?1049l")[-1].split())
    assert left == (
        "ekfsim: this terminal does not say that it draws images as kitty or iTerm2 do, or sixels; "
        "--show text draws with letters"
    )


def test_what_is_no_terminal_is_not_asked():
    played = ekfsim("play", "short.yaml", "--show", "image", keys=b"nq")
    assert (played.status, played.out) == (2, "")
    assert played.err == (
        "ekfsim: --show image draws in a terminal, and this is none that can be drawn on; "
        "--show files draws into a file\n"
    )


def test_what_is_saved_is_shown_at_the_same_step(place):
    terminal = Terminal("play", "short.yaml", "--show", "text", "--watch")
    terminal.press(b"nn")
    terminal.wait_for("step 2 of 3, view 2 of 4")
    (place / "short.yaml").write_text(SHORT.replace("  - say: The end.\n", ""))
    terminal.wait_for("step 2 of 2, view 2 of 3 · Read again")
    (place / "short.yaml").write_text(SHORT.replace("sense", "sens").replace("move", "mov"))
    terminal.wait_for("short.yaml:4:5: commands[1]: 'sens' is not a command; did you mean 'sense'?")
    assert "short.yaml:3:5: commands[0]: 'mov' is not a command" in terminal.shown
    (place / "world.yaml").write_text(WORLD.replace("lab", "hall"))
    (place / "new").write_text("world: world.yaml\ncommands:\n  - sense: {angle: 0}\n")
    (place / "new").replace(place / "short.yaml")
    terminal.wait_for("Read again; there is no step 2, the run ends at step 1")
    (place / "short.yaml").write_text(SHORT)
    terminal.wait_for("step 2 of 3, view 2 of 4 · Read again")  # where it was before
    terminal.press(b"q")
    assert terminal.status() == 0
    assert "Traceback" not in terminal.shown


def test_nobody_watches_a_pipe():
    played = ekfsim("play", "short.yaml", "--watch", keys=b"nq")
    assert (played.status, played.out) == (2, "")
    assert played.err == (
        "ekfsim: --watch shows what is saved to whoever sits before a terminal that can be drawn "
        "on, and there is none; leave it out\n"
    )
