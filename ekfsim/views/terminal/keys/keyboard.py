"""One key at a time, from a terminal, a console window or a pipe.

    with keys() as next_key:
        while (key := next_key()) != "q":
            ...

The terminal hands over single keys without echo for the whole block, so that keys held down or
typed ahead while a step is computed wait their turn. It is put back on every way out: end of block,
exception, Ctrl-C, SIGTERM, Ctrl-Z.
"""

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO, TypeVar, overload

from ekfsim.views.terminal.keys.sources import Drawn, Source, piped, terminal

T = TypeVar("T")

NO_MORE = ""  # the key that comes when the input is over
UNNAMED = "unnamed"  # a key that has no name here

CHARACTERS = {  # keys that send a control character
    **dict.fromkeys("\r\n", "enter"),
    **dict.fromkeys("\b\x7f", "backspace"),
    "\t": "tab",
    "\x04": "ctrl+d",
    "\x12": "ctrl+r",
    "\x1a": "ctrl+z",
}
SEQUENCES = {  # what follows "Esc [" or "Esc O", modifiers left out
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
    "5~": "pageup",
    "6~": "pagedown",
    "3~": "delete",
    **dict.fromkeys(["H", "1~", "7~"], "home"),  # of xterm, of the Linux console, of rxvt
    **dict.fromkeys(["F", "4~", "8~"], "end"),
    **dict.fromkeys(["P", "[A", "11~"], "f1"),
}
ALONE = 0.8  # s after which an Esc begins no other key: over a slow line bytes come one by one
PATIENCE = 1.0  # s for the rest of a key whose beginning has come
ANSWER_DELAY = 0.05  # s for the next byte of what a terminal answers: it comes together
CONTINUATIONS = {0b1100: 1, 0b1101: 1, 0b1110: 2, 0b1111: 3}  # by UTF-8's first four bits


class Keyboard:
    """Puts bytes together to names of keys.
    Holds back no more than the bytes of the key it is reading.
    """

    def __init__(self, source: Source, skipped: str = "") -> None:
        self._source = source
        self._skipped = skipped  # characters that are no keys here
        self._ahead = b""  # read, but not part of the last key
        self._escaped = (
            False  # the last byte was an Esc: what follows may belong to it, however late
        )
        self._alone_at = math.inf  # when that Esc is said to be a key of its own

    @overload
    def __call__(self) -> str: ...
    @overload
    def __call__(self, timeout: float | None) -> str | None: ...
    def __call__(self, timeout: float | None = None) -> str | None:
        """The name of the next key: its character, or what it is called ("left", "enter").

        NO_MORE at the end of the input, None where none came for `timeout` s.
        """
        deadline = math.inf if timeout is None else time.monotonic() + timeout
        while True:
            until = min(deadline, self._alone_at)
            character = self._character(
                None if until == math.inf else max(0.0, until - time.monotonic())
            )
            if character is None and self._alone_at <= deadline:
                self._alone_at = math.inf
                return "escape"
            if character is None:
                return None
            if character == "":
                return NO_MORE
            escaped, soon = self._escaped, self._alone_at < math.inf
            self._escaped = character == "\x1b"
            self._alone_at = time.monotonic() + ALONE if self._escaped else math.inf
            if escaped and character in "[O":
                return SEQUENCES.get(self._parameters(), UNNAMED)
            if escaped and soon and character in "]P_^X":
                return self._answer()
            if not self._escaped and character not in self._skipped:  # Alt and a key is that key
                return CHARACTERS.get(character, character)

    def lend(self, reader: Callable[[Source], tuple[T, bytes]]) -> T:
        """Let somebody read what comes, as a terminal's answers; what he hands back are keys."""
        found, keys = reader(self._source)
        self._ahead += keys
        return found

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
        """The next character of UTF-8, however many bytes it has; U+FFFD for what is none."""
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

    def _answer(self) -> str:
        """Pass over what a terminal answers late to a question of some other program."""
        while (byte := self._byte(ANSWER_DELAY)) and byte not in b"\a\\":
            pass
        return UNNAMED

    def _parameters(self) -> str:
        """The rest of a sequence, without modifiers: "C" for "1;5C", "5~" for "5;2~"."""
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
def keys(stream: TextIO | None = None, drawn: Drawn | None = None) -> Iterator[Keyboard]:
    """Single keys of a stream, standard input unless told; of a pipe all but line ends.

    drawn : what takes the terminal that the keys come from as its screen, and gives it back
    """
    stream = stream or sys.stdin
    if stream is None or stream.closed:  # some start a program without standard input
        yield Keyboard(lambda timeout: b"")
    elif not stream.isatty():
        yield Keyboard(piped(stream), skipped="\r\n")
    else:
        with terminal(stream, drawn) as source:
            yield Keyboard(source)
