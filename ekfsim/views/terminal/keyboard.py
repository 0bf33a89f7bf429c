"""One key at a time, from a terminal, a console window or a pipe.

    with keys() as next_key:
        while (key := next_key()) is not Action.QUIT:
            ...

The terminal hands over single keys without echo for the whole block, so that keys held down or
typed ahead while a step is computed wait their turn. It is put back on every way out: end of block,
exception, Ctrl-C, SIGTERM, Ctrl-Z.
"""

import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from enum import Enum
from types import FrameType
from typing import NoReturn, TextIO, overload


class Action(Enum):
    """What a key asks for."""

    NEXT = "next"
    BACK = "back"
    QUIT = "quit"
    RESTART = "restart"
    SAVE = "save"
    EXPLAIN = "explain"
    HELP = "help"
    UNKNOWN = "unknown"


Key = Action | int  # a digit is its number

HELP = """\
n  space  Enter  right  down  PageDown    next view
p  Backspace  left  up  PageUp            previous view
12n  12p                                  twelve of them
r  restart      s  save the picture       ?  h  this help
e  the narrative in its long form: every equation; e again for the short one
q  Ctrl-D  quit"""

CHARACTERS: dict[str, Key] = {
    **{str(digit): digit for digit in range(10)},
    **dict.fromkeys("n \r\n", Action.NEXT),
    **dict.fromkeys("p\b\x7f", Action.BACK),
    **dict.fromkeys("q\x04", Action.QUIT),
    **dict.fromkeys("?h", Action.HELP),
    "r": Action.RESTART,
    "s": Action.SAVE,
    "e": Action.EXPLAIN,
}
SEQUENCES: dict[str, Action] = {  # what follows "Esc [" or "Esc O", modifiers left out
    **dict.fromkeys(["C", "B", "6~"], Action.NEXT),  # → ↓ PageDown
    **dict.fromkeys(["D", "A", "5~"], Action.BACK),  # ← ↑ PageUp
    **dict.fromkeys(["P", "[A", "11~"], Action.HELP),  # F1 of xterm, of the Linux console, of rxvt
}
# s after which an Esc was no beginning of another key: over a slow line its bytes arrive one by one
ALONE = 0.8
PATIENCE = 1.0  # s for the rest of a key whose beginning has come
ANSWER_DELAY = 0.05  # s for the next byte of what a terminal answers: it comes together
# of UTF-8, by the upper half of the first byte
CONTINUATIONS = {0b1100: 1, 0b1101: 1, 0b1110: 2, 0b1111: 3}
# s; a signal that comes just before a wait begins is noticed when that wait ends
SIGNAL_DELAY = 0.2
MOST = 9999  # repetitions: more digits than that are a hand resting on the keyboard

# Waits at most so many s (None: without end) → the next byte or bytes, b"" at the end, None where
# nothing came.
Source = Callable[[float | None], bytes | None]


class Counted:
    """Digits before a key repeat it: 1, 2, n is twelve times `next`.

    >>> counted = Counted()
    >>> [counted.press(key) for key in (1, 2, Action.NEXT, Action.NEXT)]
    [None, None, (<Action.NEXT: 'next'>, 12), (<Action.NEXT: 'next'>, 1)]
    """

    def __init__(self) -> None:
        self.typed = 0  # the number so far, 0 where none was typed

    def press(self, key: Key) -> tuple[Action, int] | None:
        """The action and how often, or None while a number is being typed. Only next and back
        repeat.
        """
        if not isinstance(key, Action):
            self.typed = min(10 * self.typed + key, MOST)
            return None
        count, self.typed = max(self.typed, 1), 0
        return key, count if key in (Action.NEXT, Action.BACK) else 1


class Keyboard:
    """Puts bytes together to keys. Holds back no more than the bytes of the key it is reading."""

    def __init__(self, source: Source, skipped: str = "") -> None:
        self._source = source
        self._skipped = skipped  # characters that are no keys here
        self._ahead = b""  # read, but not part of the last key
        # an Esc was the last byte: what follows may belong to it, however late
        self._escaped = False
        self._alone_at = math.inf  # when that Esc is said to be a key of its own

    @overload
    def __call__(self) -> Key: ...
    @overload
    def __call__(self, timeout: float | None) -> Key | None: ...
    def __call__(self, timeout: float | None = None) -> Key | None:
        """The next key, QUIT at the end of the input, or None where none was pressed for `timeout`
        s.
        """
        deadline = math.inf if timeout is None else time.monotonic() + timeout
        while True:
            until = min(deadline, self._alone_at)
            character = self._character(
                None if until == math.inf else max(0.0, until - time.monotonic())
            )
            if character is None and self._alone_at <= deadline:
                self._alone_at = math.inf
                return Action.UNKNOWN
            if character is None:
                return None
            if character == "":
                return Action.QUIT
            escaped, soon = self._escaped, self._alone_at < math.inf
            self._escaped = character == "\x1b"
            self._alone_at = time.monotonic() + ALONE if self._escaped else math.inf
            if escaped and character in "[O":
                return SEQUENCES.get(self._parameters(), Action.UNKNOWN)
            if escaped and soon and character in "]P_^X":
                return self._answer()
            if not self._escaped and character not in self._skipped:  # Alt and a key is that key
                return CHARACTERS.get(character.lower(), Action.UNKNOWN)

    def _byte(self, timeout: float | None) -> bytes | None:
        """The next byte, b"" at the end, None where it does not come in time."""
        if not self._ahead:
            arrived = self._source(timeout)
            if not arrived:
                return arrived
            self._ahead = arrived
        byte, self._ahead = self._ahead[:1], self._ahead[1:]
        return byte

    def _character(self, timeout: float | None) -> str | None:
        """The next character of UTF-8, however many bytes it has; U+FFFD for bytes that are
        none.
        """
        read = self._byte(timeout)
        if not read:
            return None if read is None else ""
        for _ in range(CONTINUATIONS.get(read[0] >> 4, 0)):
            following = self._byte(PATIENCE)
            if not following or following[0] >> 6 != 0b10:  # not its continuation: a key of its own
                self._ahead = (following or b"") + self._ahead
                break
            read += following
        return read.decode(errors="replace")

    def _answer(self) -> Action:
        """Pass over what a terminal answers late to a question of some other program."""
        while (byte := self._byte(ANSWER_DELAY)) and byte not in b"\a\\":
            pass
        return Action.UNKNOWN

    def _parameters(self) -> str:
        """The rest of a sequence to its final byte, without modifiers: "C" for "1;5C", "5~" for
        "5;2~".
        """
        read = ""
        while byte := self._byte(PATIENCE):
            if not b" " <= byte <= b"~":  # no part of any sequence: a key of its own
                self._ahead = byte + self._ahead
                return ""
            read += byte.decode()
            if byte >= b"@" and read != "[":  # the Linux console sends F1 as Esc [ [ A
                break
        final = read[-1:]
        if final == "~":
            return read.rstrip("~").split(";")[0] + "~"
        return read if read.startswith("[") else final


@contextmanager
def keys(stream: TextIO | None = None) -> Iterator[Keyboard]:
    """Single keys from a stream, standard input where none is given. Not a terminal: its
    characters, less line ends.
    """
    stream = stream or sys.stdin
    if stream is None or stream.closed:  # some start a program without standard input
        yield Keyboard(lambda timeout: b"")
    elif not stream.isatty():
        yield Keyboard(_piped(stream), skipped="\r\n")
    else:
        with _terminal(stream) as source:
            yield Keyboard(source)


if sys.platform == "win32":
    import msvcrt

    # as a terminal has them
    CODES = {"H": "A", "P": "B", "M": "C", "K": "D", "I": "5~", "Q": "6~", ";": "11~"}

    def _piped(stream: TextIO) -> Source:
        """Windows cannot wait for a pipe, so a timeout counts for nothing here."""
        return lambda timeout: stream.read(1).encode()

    @contextmanager
    def _terminal(stream: TextIO) -> Iterator[Source]:
        """The console hands over single keys anyhow."""

        def source(timeout: float | None) -> bytes | None:
            deadline = None if timeout is None else time.monotonic() + timeout
            while deadline is not None and not msvcrt.kbhit():
                if time.monotonic() >= deadline:
                    return None
                time.sleep(0.01)
            character = msvcrt.getwch()
            if character in "\x00\xe0":
                return b"\x1b[" + CODES.get(msvcrt.getwch(), "?~").encode()
            if character == "\x03":
                raise KeyboardInterrupt
            return b"\x04" if character == "\x1a" else character.encode(errors="replace")

        yield source

else:
    import select
    import termios
    import tty

    def _piped(stream: TextIO) -> Source:
        """A pipe or file by its descriptor; where there is none (a stream made of text), by its
        characters.
        """
        try:
            return _descriptor(stream.fileno())
        except OSError:
            return lambda timeout: stream.read(1).encode()

    def _descriptor(fd: int) -> Source:
        """One byte at a time past all buffers: what is not used stays for the next reader."""

        def source(timeout: float | None) -> bytes | None:
            deadline = math.inf if timeout is None else time.monotonic() + timeout
            while True:
                wait = min(max(0.0, deadline - time.monotonic()), SIGNAL_DELAY)
                if not select.select([fd], [], [], wait)[0]:
                    if time.monotonic() >= deadline:
                        return None
                    continue
                try:
                    return os.read(fd, 1)
                except BlockingIOError:  # someone else was quicker
                    continue
                except OSError:  # the terminal is gone, or is no longer ours
                    return b""

        return source

    @contextmanager
    def _terminal(stream: TextIO) -> Iterator[Source]:
        """Single keys without echo (cbreak: Ctrl-C and Ctrl-Z still signal) until the block
        ends.
        """
        fd = stream.fileno()
        # the terminal's own settings, once they were changed
        original: list[list[int | list[bytes | int]]] = []

        def enter(*_: object) -> None:
            # from the background it would stop us; `fg` brings us here again
            if _in_foreground(fd):
                with suppress(termios.error):  # the terminal is gone
                    if not original:
                        original.append(termios.tcgetattr(fd))
                    # DRAIN, not FLUSH: keeps what was typed ahead
                    tty.setcbreak(fd, termios.TCSADRAIN)

        def leave() -> None:
            if original and _in_foreground(fd):
                with suppress(termios.error):
                    termios.tcsetattr(fd, termios.TCSADRAIN, original[0])

        def suspend(*_: object) -> None:
            leave()
            signal.signal(signal.SIGTSTP, signal.SIG_DFL)
            os.kill(os.getpid(), signal.SIGTSTP)  # stops here, until `fg` or `bg`
            signal.signal(signal.SIGTSTP, suspend)
            enter()

        # a drawing library's compiled code may swallow what `end` raises: told again at next key
        came: list[int] = []

        def end(number: int, _: FrameType | None) -> NoReturn:
            came.append(number)
            raise SystemExit(128 + number)

        source = _descriptor(fd)

        def heeding(timeout: float | None) -> bytes | None:
            deadline = math.inf if timeout is None else time.monotonic() + timeout
            while True:
                if came:
                    raise SystemExit(128 + came[0])
                wait = min(max(0.0, deadline - time.monotonic()), SIGNAL_DELAY)
                if not _in_foreground(fd):
                    time.sleep(wait)
                    byte = None
                else:
                    if _by_lines(fd):  # after `bg` and `fg`, of which no signal tells
                        enter()
                    byte = source(wait)
                if byte is not None or time.monotonic() >= deadline:
                    return byte

        endings = dict.fromkeys((signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT), end)
        with _handling({signal.SIGCONT: enter, signal.SIGTSTP: suspend, **endings}):
            try:
                enter()
                yield heeding
            finally:
                leave()

    def _in_foreground(fd: int) -> bool:
        """Whether the terminal listens to us; one that controls no jobs listens to everybody."""
        try:
            return os.tcgetpgrp(fd) == os.getpgrp()
        except OSError:
            return True

    def _by_lines(fd: int) -> bool:
        """Whether the terminal keeps keys back until a line is whole."""
        try:
            return bool(termios.tcgetattr(fd)[3] & termios.ICANON)
        except termios.error:  # it is gone
            return False

    Handler = Callable[[int, FrameType | None], object]

    @contextmanager
    def _handling(handlers: Mapping[signal.Signals, Handler]) -> Iterator[None]:
        """Signal handlers for a block; Python allows them on the main thread only. What is ignored
        stays ignored.
        """
        previous = {}
        if threading.current_thread() is threading.main_thread():
            for number, handler in handlers.items():
                if signal.getsignal(number) is not signal.SIG_IGN:
                    previous[number] = signal.signal(number, handler)
        try:
            yield
        finally:
            for number, before in previous.items():
                signal.signal(number, before if before is not None else signal.SIG_DFL)
