"""How the process begins and ends:
streams, signals, exit statuses, and mistakes told in sentences.
"""

import atexit
import gc
import os
import re
import shutil
import signal
import sys
from collections.abc import Iterable
from contextlib import suppress
from types import FrameType
from typing import Any, NoReturn

import click

from ekfsim.errors import MOST_TOLD, EkfsimError, first_of
from ekfsim.printable import in_a_line
from ekfsim.printable import shown as shown

INTERRUPTED = 130
_ending: list[int] = []  # the signal that is to end us, once it has come
_parting: list[str] = []  # what is left to say where we are ended

# what a command makes has no rings in it, or stays to the end: seldom looked through, and not once
# more before the end, which takes as long as to read a long file
SELDOM = 100_000  # objects; Python itself looks after 700
atexit.register(gc.freeze)


def run(program: click.Group) -> NoReturn:
    """Run a program and exit with its status:
    0 done, 1 the run failed, 2 wrong usage or file, 130, 143.
    """
    gc.set_threshold(SELDOM)
    # of pydantic; to look for some goes through all that is installed
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    _open_closed_streams()
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)  # Windows does not hang up
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, ValueError):
            stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    _ending.clear()
    _parting.clear()
    try:
        status = _status(program)
    except (Exception, SystemExit):
        if not _ending:
            raise
        status = 1  # our own way out, or what a library made of the signal's exception
    if status == INTERRUPTED or _ending[:1] == [signal.SIGINT]:
        say("; ".join(["interrupted", *filter(None, _parting)]))
    elif _ending and _parting:
        say("; ".join(["ended", *filter(None, _parting)]))
    sys.exit(128 + _ending[0] if _ending else status)


def _status(program: click.Group) -> int:
    """What the program's exit status is;
    mistakes of its user end here in a sentence, ours keep their traceback.
    """
    try:
        program(prog_name="ekfsim", standalone_mode=False)
        sys.stdout.flush()
        return 0
    except click.ClickException as mistake:
        with suppress(OSError):
            mistake.show()
        return mistake.exit_code
    except EkfsimError as error:
        warn(error.remarks)
        say(*str(error).split("\n"))
        return error.status
    except (KeyboardInterrupt, click.Abort, _InterruptedError):
        return INTERRUPTED
    except (_UnreadError, BrokenPipeError):
        _forget_what_is_buffered()
        return 0
    except OSError as refusal:
        if refusal.filename is not None:
            raise  # no write to standard output, but a mistake of ours
        _forget_what_is_buffered()
        say(f"writing to standard output failed: {refusal.strerror}")
        return 1


def _open_closed_streams() -> None:
    """Give a stream that was closed by whoever started us (`>&-`) to /dev/null:
    no result must come in its place.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115


def _forget_what_is_buffered() -> None:
    """What could not be written to standard output must not fail once more at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _end(number: int, frame: FrameType | None) -> None:
    """End by an exception, so that every block cleans up behind itself,
    undisturbed by whoever is impatient.
    """
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    _ending.append(number)
    heed()


def heed() -> None:
    """End if a signal asked for it: its exception is lost where it comes up inside a library's
    compiled code.
    """
    if _ending and _ending[0] == signal.SIGINT:
        raise KeyboardInterrupt
    if _ending:
        sys.exit(128 + _ending[0])


def part_with(words: str = "") -> None:
    """Tell it in a line where SIGTERM ends us, as of Ctrl-C always;
    and have these words stand in that line.
    """
    _parting.append(words)


def say(*lines: str) -> None:
    """Tell the user something on standard error:
    a mistake with its place as it is, all else in our name.
    """
    with suppress(OSError):
        told = map(in_a_line, lines)
        click.echo(
            "\n".join(line if _placed(line) else f"ekfsim: {line}" for line in told), err=True
        )


def warn(warnings: Iterable[str], most: int = MOST_TOLD) -> None:
    """Tell the user what is odd, a line each, and of very much only the first."""
    for line in first_of(warnings, most):
        say(line)


def width() -> int | None:
    """How many columns the terminal has that results are printed on;
    None where they go elsewhere.
    """
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def _placed(line: str) -> bool:
    """Whether a line begins with file:line:col, or, of a student's code, with file.py:line: an
    editor wants to find it at its very start.
    """
    return re.match(r"[^:]*:\d+:\d+:|[^:]*\.py:\d+: ", line) is not None


class _UnreadError(Exception):
    """Whoever read our output has seen enough."""


class _InterruptedError(Exception):
    """Ctrl-C, by another name than that which click answers with an empty line."""


class Program(click.Group):
    """The commands. click itself would make a failure of a closed pipe."""

    def make_context(
        self,
        info_name: str | None,
        args: list[str],
        parent: click.Context | None = None,
        **extra: Any,
    ) -> click.Context:
        """Parse the arguments, and print the help that they ask for."""
        try:
            return super().make_context(info_name, args, parent, **extra)
        except BrokenPipeError:
            raise _UnreadError from None

    def invoke(self, ctx: click.Context) -> Any:
        """Do what the arguments ask for."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise _UnreadError from None
        except KeyboardInterrupt:
            if sys.stderr.isatty():
                click.echo(err=True)  # behind the ^C that the terminal shows
            raise _InterruptedError from None
