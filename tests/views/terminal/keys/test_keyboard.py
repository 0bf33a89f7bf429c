"""Keys are pressed on real pseudo-terminals; nothing here waits for a fixed time to pass."""

import io
import os
import signal
import subprocess
import sys
import termios
import textwrap
import threading
import time
from collections.abc import Iterator

import pytest

from ekfsim.views.terminal.keys import keyboard
from ekfsim.views.terminal.keys.keyboard import NO_MORE, UNNAMED, Keyboard, keys

PLAYER = """
    import sys
    from ekfsim.views.terminal.keys.keyboard import keys
    with keys() as next_key:
        print("ready", flush=True)
        while (key := next_key()) not in ("q", "ctrl+d", ""):
            print(f"<{key}>", flush=True)
    print("<quit>", flush=True)
"""
CONTROLLING = """
    import fcntl, os, sys, termios
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    os.execvp(sys.argv[1], sys.argv[1:])
"""


class Terminal:
    """A pseudo-terminal: we are its screen and its keyboard."""

    def __init__(self) -> None:
        self.screen, self.line = os.openpty()
        self.shown = ""
        self.processes: list[subprocess.Popen] = []

    def press(self, text: str) -> None:
        os.write(self.screen, text.encode())

    def settings(self) -> list:
        return termios.tcgetattr(self.line)

    def single_keys(self) -> bool:
        return not self.settings()[3] & (termios.ICANON | termios.ECHO)

    def run(self, *command: str) -> subprocess.Popen:
        """Start a command that this terminal controls."""
        launcher = [sys.executable, "-c", textwrap.dedent(CONTROLLING), *command]
        line = self.line
        process = subprocess.Popen(
            launcher, stdin=line, stdout=line, stderr=line, start_new_session=True
        )
        self.processes.append(process)
        return process

    def wait_for(self, text: str) -> None:
        """Read what is shown until the text has come; what follows it is kept for the next call."""
        while text not in self.shown:
            self.shown += os.read(self.screen, 1024).decode()
        self.shown = self.shown.split(text, 1)[1]


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    terminal = Terminal()
    yield terminal
    for process in terminal.processes:  # over by now, unless a test failed
        process.kill()
        process.wait()
    os.close(terminal.screen)
    os.close(terminal.line)


@pytest.fixture(autouse=True)
def _never_wait_long() -> Iterator[None]:
    def give_up(*_: object) -> None:
        raise TimeoutError

    previous = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(20)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, previous)


def player() -> list[str]:
    return [sys.executable, "-c", textwrap.dedent(PLAYER)]


def pressed(text: bytes) -> list:
    """All keys of a text, read byte by byte, up to the NO_MORE that its end gives."""
    stream = io.BytesIO(text)
    keyboard = Keyboard(lambda timeout: stream.read(1))
    read = []
    while stream.tell() < len(text) or keyboard._ahead:
        read.append(keyboard())
    return read


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (b"n \r\nN", ["n", " ", "enter", "enter", "N"]),
        (b"p\b\x7f", ["p", "backspace", "backspace"]),
        (b"q\x04", ["q", "ctrl+d"]),
        (b"0123456789", list("0123456789")),
        (b"x\t/", ["x", "tab", "/"]),
        (b"\x1b[C\x1b[B\x1b[6~\x1bOC\x1bOB", ["right", "down", "pagedown", "right", "down"]),
        (b"\x1b[D\x1b[A\x1b[5~\x1bOD\x1bOA", ["left", "up", "pageup", "left", "up"]),
        (b"\x1b[1;5C\x1b[5;2~", ["right", "pageup"]),  # with Ctrl, with Shift
        (b"\x1bOP\x1b[11~\x1b[[A", ["f1"] * 3),
        (b"\x1b[H\x1b[F\x1b[1~\x1b[4~\x1bOH\x1b[8~", ["home", "end"] * 3),
        (b"\x1b[3~\x1b[15~\x1b[24;6~\x1bOS\x1b[[En", ["delete", *[UNNAMED] * 4, "n"]),
        (b"\x1b[200000;1;2;3;4;5;6;7;8m\x1b[?1;2cn", [UNNAMED, UNNAMED, "n"]),
        (
            b"\x1b]11;rgb:0000/nnnn/qqqq\x1b\\n\x1bP1$r0q\x07n",
            [UNNAMED, "n", UNNAMED, "n"],
        ),
        (b"\x1b[\x1b[Cn", [UNNAMED, "right", "n"]),  # cut short by the next sequence
        (b"\x1bn\x1b\r\x1bp\x1b7\x1b\x1b[C", ["n", "enter", "p", "7", "right"]),  # with Alt
        (b"\x1bqn", ["q", "n"]),
        (b"\x1b", [NO_MORE]),  # the end of the input
        ("éñ机🤖n".encode(), list("éñ机🤖n")),
        # no UTF-8: the n is not swallowed
        (b"\xe9n\xffn\x80n\xe6\x9cn", ["\ufffd", "n"] * 4),
    ],
)
def test_names_of_keys(text: bytes, expected: list) -> None:
    assert pressed(text) == expected


def test_type_ahead_is_one_key_at_a_time_without_echo(terminal: Terminal) -> None:
    terminal.press("n")  # before the block, when the terminal still waits for whole lines
    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        terminal.press("nnq")
        assert [next_key() for _ in range(4)] == list("nnnq")
        os.write(terminal.line, b"end")
    terminal.wait_for("end")
    assert terminal.shown == ""


def test_keys_held_while_a_step_is_computed_all_arrive_unseen(terminal: Terminal) -> None:
    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        for _ in range(6):  # the step takes the time of six repeats
            terminal.press("n")
        assert [next_key(0.0) for _ in range(7)] == ["n"] * 6 + [None]
        os.write(terminal.line, b"end")
        assert os.read(terminal.screen, 100) == b"end"


def test_escape_alone_does_nothing_and_takes_no_key_away(
    terminal: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keyboard, "ALONE", 0.02)
    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        terminal.press("\x1b")
        assert [next_key(), next_key(0.03)] == ["escape", None]
        terminal.press("Pq\x1b")  # not the P that a terminal's answer begins with
        assert [next_key(), next_key(), next_key(0.01), next_key(1.0)] == ["P", "q", None, "escape"]
        terminal.press("\x1b[C\x1b[5~é1")
        assert [next_key() for _ in range(4)] == ["right", "pageup", "é", "1"]


@pytest.mark.parametrize("key", ["\x1b[C", "\x1bOC", "\x1b[6~", "\x1b[1;5C"])
def test_the_bytes_of_a_key_may_come_one_by_one(
    terminal: Terminal, key: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for delay in ("ALONE", "PATIENCE"):
        monkeypatch.setattr(keyboard, delay, 5.0)  # however busy the machine is

    def press_slowly() -> None:
        for byte in key:
            terminal.press(byte)
            time.sleep(0.06)

    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        thread = threading.Thread(target=press_slowly)
        thread.start()
        while (pressed := next_key(0.01)) is None:  # as often as one likes to ask
            pass
        assert pressed in ("right", "pagedown")
        thread.join()


def test_an_arrow_is_one_however_late_the_rest_of_it_comes(
    terminal: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keyboard, "ALONE", 0.01)
    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        terminal.press("\x1b")
        assert next_key() == "escape"
        terminal.press("[Dn")
        assert [next_key(), next_key()] == ["left", "n"]


def test_delays_of_a_slow_line_are_waited_for() -> None:
    assert min(keyboard.ALONE, keyboard.PATIENCE) > 0.6


def test_polling_returns_none_in_time(terminal: Terminal) -> None:
    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        began = time.monotonic()
        assert next_key(timeout=0.02) is None
        assert time.monotonic() - began > 0.015
        terminal.press("p")
        assert next_key(timeout=5) == "p"


def test_what_was_not_asked_for_stays_for_the_next_reader(terminal: Terminal) -> None:
    with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
        terminal.press("qls\n")
        assert next_key() == "q"
    assert os.read(terminal.line, 100) == b"ls\n"


def test_an_exception_restores_the_terminal(terminal: Terminal) -> None:
    before, handler = terminal.settings(), signal.getsignal(signal.SIGTERM)

    def fail() -> None:
        with open(terminal.line, closefd=False) as stream, keys(stream):
            assert terminal.single_keys()
            assert signal.getsignal(signal.SIGTERM) is not handler
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert terminal.settings() == before
    assert signal.getsignal(signal.SIGTERM) is handler


def test_another_thread_can_read_keys(terminal: Terminal) -> None:
    before, read = terminal.settings(), []

    def work() -> None:
        with open(terminal.line, closefd=False) as stream, keys(stream) as next_key:
            read.append(next_key())

    terminal.press("n\n")
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert read == ["n"]
    assert terminal.settings() == before


@pytest.mark.parametrize(
    ("end", "status"), [("q", 0), ("\x1b\x1bq", 0), ("\x04", 0), ("\x03", -signal.SIGINT)]
)
def test_every_way_out_restores_the_terminal(terminal: Terminal, end: str, status: int) -> None:
    before = terminal.settings()
    process = terminal.run(*player())
    terminal.wait_for("ready")
    assert terminal.single_keys()
    terminal.press("n")
    terminal.wait_for("<n>")  # Ctrl-C would discard it
    terminal.press(end)
    assert process.wait() == status
    assert terminal.settings() == before


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_restores_the_terminal(terminal: Terminal, number: signal.Signals) -> None:
    before = terminal.settings()
    process = terminal.run(*player())
    terminal.wait_for("ready")
    process.send_signal(number)
    assert process.wait() == 128 + number
    assert terminal.settings() == before


def test_stopped_the_shell_has_its_terminal_back_and_fg_resumes(terminal: Terminal) -> None:
    script = 'set -m; "$@"; echo stopped; read line; echo "[$line]"; fg; echo done'
    before = terminal.settings()
    process = terminal.run("sh", "-c", script, "sh", *player())
    terminal.wait_for("ready")
    terminal.press("n")
    terminal.wait_for("<n>")
    terminal.press("\x1a")
    terminal.wait_for("stopped")
    assert terminal.settings() == before
    terminal.press("whole line\n")
    terminal.wait_for("[whole line]")
    while not terminal.single_keys():  # fg is on its way
        time.sleep(0.001)
    terminal.press("pq")
    terminal.wait_for("<p>")
    terminal.wait_for("<quit>")
    terminal.wait_for("done")
    assert process.wait() == 0
    assert terminal.settings() == before


@pytest.mark.parametrize("wake", ["bg; sleep 0.1; fg", "bg; fg"])
def test_sent_to_the_background_and_back_it_has_its_keys_again(
    terminal: Terminal, wake: str
) -> None:
    script = f'set -m; "$@"; echo stopped; read line; {wake}; echo done'
    before = terminal.settings()
    process = terminal.run("bash", "-c", script, "bash", *player())
    terminal.wait_for("ready")
    terminal.press("n")
    terminal.wait_for("<n>")
    terminal.press("\x1a")
    terminal.wait_for("stopped")
    terminal.press("\n")
    while not terminal.single_keys():
        time.sleep(0.001)
    terminal.press("p")
    terminal.wait_for("<p>")
    terminal.press("q")
    terminal.wait_for("<quit>")
    terminal.wait_for("done")
    assert process.wait() == 0
    assert terminal.settings() == before


def test_in_the_background_it_leaves_the_terminal_alone(terminal: Terminal) -> None:
    script = 'set -m; "$@" & read line; fg; echo done'
    before = terminal.settings()
    process = terminal.run("sh", "-c", script, "sh", *player())
    terminal.wait_for("ready")  # it has passed what would stop it, had it touched the terminal
    assert terminal.settings() == before
    terminal.press("\n")
    while not terminal.single_keys():
        time.sleep(0.001)
    terminal.press("q")
    terminal.wait_for("<quit>")
    terminal.wait_for("done")
    assert process.wait() == 0
    assert terminal.settings() == before


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (b"nnq", "<n> <n> <quit>"),
        (b"n\r\np\n\nq\nn", "<n> <p> <quit>"),
        (b"12np", "<1> <2> <n> <p> <quit>"),
        (b"\x1b[Cx", "<right> <x> <quit>"),
        (b"", "<quit>"),
    ],
)
def test_a_pipe_is_read_to_its_end(text: bytes, expected: str) -> None:
    result = subprocess.run(
        player(), input=text, capture_output=True, check=True, start_new_session=True
    )
    assert result.stdout.decode().split() == ["ready", *expected.split()]
    assert result.stderr == b""


def test_a_pipe_keeps_what_was_not_asked_for() -> None:
    ours, theirs = os.pipe()
    os.write(theirs, b"nqrest")
    with open(ours) as stream, keys(stream) as next_key:
        assert [next_key(), next_key()] == ["n", "q"]
        assert next_key._ahead == b""
        assert os.read(ours, 100) == b"rest"
        assert next_key(timeout=0.001) is None
        os.close(theirs)
        assert [next_key(), next_key(1.0)] == [NO_MORE, NO_MORE]


def test_nothing_to_read_is_quit(monkeypatch: pytest.MonkeyPatch) -> None:
    with open(os.devnull) as stream, keys(stream) as next_key:
        assert next_key() == NO_MORE
    with keys(io.StringIO("né")) as next_key:
        assert [next_key(), next_key(), next_key()] == ["n", "é", NO_MORE]
    monkeypatch.setattr(sys, "stdin", None)
    with keys() as next_key:
        assert next_key(timeout=1.0) == NO_MORE


def test_a_terminal_that_goes_away_is_quit() -> None:
    screen, line = os.openpty()
    with open(line) as stream, keys(stream) as next_key:
        os.close(screen)
        assert next_key() == NO_MORE
