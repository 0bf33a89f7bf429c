"""One key at a time, from a terminal, a console window or a pipe.

    with keys() as next_key:
        while (key := next_key()) is not Action.QUIT:
            ...

The terminal hands over single keys without echo for the whole block, so that keys held down or
typed ahead while a step is computed wait their turn. It is put back on every way out: end of block,
exception, Ctrl-C, SIGTERM, Ctrl-Z.
"""

import math
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from enum import Enum
from typing import TextIO, overload

from ekfsim.views.terminal.sources import Source, piped, terminal


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
ALONE = 0.8  # s after which an Esc begins no other key: over a slow line bytes come one by one
PATIENCE = 1.0  # s for the rest of a key whose beginning has come
ANSWER_DELAY = 0.05  # s for the next byte of what a terminal answers: it comes together
CONTINUATIONS = {0b1100: 1, 0b1101: 1, 0b1110: 2, 0b1111: 3}  # by UTF-8's first four bits
MOST = 9999  # repetitions: more digits than that are a hand resting on the keyboard


class Counted:
    """Digits before a key repeat it: 1, 2, n is twelve times `next`.

    >>> counted = Counted()
    >>> [counted.press(key) for key in (1, 2, Action.NEXT, Action.NEXT)]
    [None, None, (<Action.NEXT: 'next'>, 12), (<Action.NEXT: 'next'>, 1)]
    """

    def __init__(self) -> None:
        self.typed = 0  # the number so far, 0 where none was typed

    def press(self, key: Key) -> tuple[Action, int] | None:
        """The action and how often, None while a number is typed. Only next and back repeat."""
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
        self._escaped = (
            False  # the last byte was an Esc: what follows may belong to it, however late
        )
        self._alone_at = math.inf  # when that Esc is said to be a key of its own

    @overload
    def __call__(self) -> Key: ...
    @overload
    def __call__(self, timeout: float | None) -> Key | None: ...
    def __call__(self, timeout: float | None = None) -> Key | None:
        """The next key, QUIT at the end of the input, None where none came for `timeout` s."""
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

    def _answer(self) -> Action:
        """Pass over what a terminal answers late to a question of some other program."""
        while (byte := self._byte(ANSWER_DELAY)) and byte not in b"\a\\":
            pass
        return Action.UNKNOWN

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
def keys(stream: TextIO | None = None) -> Iterator[Keyboard]:
    """Single keys of a stream, standard input unless told; of a pipe all but line ends."""
    stream = stream or sys.stdin
    if stream is None or stream.closed:  # some start a program without standard input
        yield Keyboard(lambda timeout: b"")
    elif not stream.isatty():
        yield Keyboard(piped(stream), skipped="\r\n")
    else:
        with terminal(stream) as source:
            yield Keyboard(source)
