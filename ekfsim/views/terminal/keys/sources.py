"""Where the bytes of keys come from: a terminal, a console window, a pipe."""

import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from types import FrameType
from typing import NoReturn, Protocol, TextIO

SIGNAL_DELAY = 0.2  # s; a signal that comes just before a wait is noticed when that wait ends

# Waits at most so many s (None: without end) → the next byte or bytes, b"" at the end, None where
# nothing came.
Source = Callable[[float | None], bytes | None]
Handler = Callable[[int, FrameType | None], object]


class Drawn(Protocol):
    """What is drawn on a terminal while its keys are read."""

    def enter(self) -> None:
        """Take the terminal, at the start or again: what stood there is no longer known."""

    def leave(self) -> None:
        """Give it back as it was."""


if sys.platform == "win32":
    import msvcrt

    # as a terminal has them
    CODES = {"H": "A", "P": "B", "M": "C", "K": "D", "I": "5~", "Q": "6~", ";": "11~"}

    def piped(stream: TextIO) -> Source:
        """Windows cannot wait for a pipe, so a timeout counts for nothing here."""
        return lambda timeout: stream.read(1).encode()

    @contextmanager
    def terminal(stream: TextIO, drawn: Drawn | None = None) -> Iterator[Source]:
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

        if drawn is not None:
            drawn.enter()
        try:
            yield source
        finally:
            if drawn is not None:
                drawn.leave()

    def pixels(stream: TextIO) -> tuple[int, int]:
        """Nothing tells them."""
        return 0, 0

else:
    import fcntl
    import select
    import struct
    import termios
    import tty

    def piped(stream: TextIO) -> Source:
        """A pipe or file, by its descriptor; a stream that has none, by its characters."""
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
    def terminal(stream: TextIO, drawn: Drawn | None = None) -> Iterator[Source]:
        """Single keys without echo until the block ends."""
        held = Held(stream.fileno(), drawn)
        with _handling(held.handlers):
            try:
                held.enter()
                yield held.wait
            finally:
                held.leave()

    def pixels(stream: TextIO) -> tuple[int, int]:
        """Width and height of a terminal, 0 where it does not tell."""
        try:
            told = fcntl.ioctl(stream.fileno(), termios.TIOCGWINSZ, bytes(8))
        except OSError:
            return 0, 0
        _, _, width, height = struct.unpack("HHHH", told)
        return width, height

    class Held:
        """A terminal that hands over single keys (cbreak: Ctrl-C and Ctrl-Z still signal)."""

        def __init__(self, fd: int, drawn: Drawn | None = None) -> None:
            self._fd, self._source, self._drawn = fd, _descriptor(fd), drawn
            # the terminal's own settings, once they were changed
            self._original: list[int | list[bytes | int]] | None = None
            # a drawing library's compiled code may swallow what `end` raises: told at the next key
            self._came: int | None = None
            endings = dict.fromkeys((signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT), self._end)
            self.handlers: Mapping[signal.Signals, Handler] = {
                signal.SIGCONT: self.enter,
                signal.SIGTSTP: self._suspend,
                **endings,
            }

        def enter(self, *_: object) -> None:
            """Ask for single keys; in the background not, where that would stop us until `fg`."""
            if _in_foreground(self._fd):
                with suppress(termios.error):  # the terminal is gone
                    if self._original is None:
                        self._original = termios.tcgetattr(self._fd)
                    # DRAIN, not FLUSH: keeps what was typed ahead
                    tty.setcbreak(self._fd, termios.TCSADRAIN)
                    if self._drawn is not None:
                        self._drawn.enter()

        def leave(self) -> None:
            """Put the terminal back as it was."""
            if self._original is not None and _in_foreground(self._fd):
                with suppress(termios.error):
                    if self._drawn is not None:
                        self._drawn.leave()
                    termios.tcsetattr(self._fd, termios.TCSADRAIN, self._original)

        def wait(self, timeout: float | None) -> bytes | None:
            """The next byte; raises what a signal asked for in the meantime."""
            deadline = math.inf if timeout is None else time.monotonic() + timeout
            while True:
                if self._came is not None:
                    raise SystemExit(128 + self._came)
                wait = min(max(0.0, deadline - time.monotonic()), SIGNAL_DELAY)
                if not _in_foreground(self._fd):
                    time.sleep(wait)
                    byte = None
                else:
                    if _by_lines(self._fd):  # after `bg` and `fg`, of which no signal tells
                        self.enter()
                    byte = self._source(wait)
                if byte is not None or time.monotonic() >= deadline:
                    return byte

        def _suspend(self, *_: object) -> None:
            self.leave()
            signal.signal(signal.SIGTSTP, signal.SIG_DFL)
            os.kill(os.getpid(), signal.SIGTSTP)  # stops here, until `fg` or `bg`
            signal.signal(signal.SIGTSTP, self._suspend)
            self.enter()

        def _end(self, number: int, _: FrameType | None) -> NoReturn:
            if self._came is None:
                self._came = number
            raise SystemExit(128 + number)

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

    @contextmanager
    def _handling(handlers: Mapping[signal.Signals, Handler]) -> Iterator[None]:
        """Signal handlers for a block, on the main thread alone; what is ignored stays ignored."""
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
