"""Where a student's code is at home: its folder, the modules beside it, and which lines are its."""

import io
import os
import re
import sys
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any, NoReturn

import numpy as np

from ekfsim.student.fault import FaultError

OURS = Path(__file__).parents[2]  # the package itself
INSTALLED = tuple(
    os.path.join(os.path.realpath(sysconfig.get_path(name)), "")
    for name in ("stdlib", "platstdlib", "purelib", "platlib")
)
CELL = re.compile(r"[/\\]ipykernel_\d+[/\\]\d+\.py$|^<ipython-input-")
MOST_WORDS = 300  # of an exception's text


class Nowhere(io.TextIOBase):
    """Where what is printed is lost."""

    def write(self, text: str) -> int:
        """As if it were written."""
        return len(text)


class Aside(io.TextIOBase):
    """Standard error, where what is printed stands in lines of its own: one that is left open ends
    where its call does, and what is told next begins anew.
    """

    def __init__(self) -> None:
        self._stream = sys.stderr
        self._open = False

    @property
    def buffer(self) -> Any:
        """For who prints bytes."""
        return self._stream.buffer

    def fileno(self) -> int:
        """That of standard error."""
        return self._stream.fileno()

    def isatty(self) -> bool:
        """Whether somebody looks at it."""
        return self._stream.isatty()

    def write(self, text: str) -> int:
        """Print it."""
        self._open = not text.endswith("\n") if text else self._open
        return self._stream.write(text)

    def flush(self) -> None:
        """Let out what was printed."""
        self._stream.flush()

    def end(self) -> None:
        """End the line that is open."""
        if self._open:
            self.write("\n")


NOWHERE = Nowhere()


@dataclass
class Home:
    """Where a student's code may import from, as if it were run there, and which lines are its.

    While its code runs the folder stands first on the path, and the modules that came from it are
    known by their names; afterwards neither: two folders may hold a helpers.py each.
    """

    folder: str | None = None  # None: code that is installed, or stands in no file
    root: str = ""  # what the paths of installed code begin with
    modules: dict[str, ModuleType] = field(default_factory=dict)
    mute: bool = False  # what is printed is told nobody: ten thousand runs would all say it

    @contextmanager
    def entered(self) -> Iterator[None]:
        """What is imported here is looked for in the folder first and leaves nothing there; what is
        printed here goes to standard error, and there is nothing to be read: a narrative is being
        told.
        """
        aside = Aside()
        heard = NOWHERE if self.mute else aside
        with redirect_stdout(heard), redirect_stderr(heard), np.errstate(all="ignore"):
            outside, here = (sys.stdin, sys.dont_write_bytecode), _here()
            sys.stdin, sys.dont_write_bytecode = io.StringIO(), True
            if self.folder is not None:
                sys.path.insert(0, self.folder)
            hidden = {name: sys.modules.get(name) for name in self.modules}
            sys.modules.update(self.modules)
            known = len(sys.modules)
            try:
                yield
            finally:
                sys.stdin, sys.dont_write_bytecode = outside
                if here is not None and _here() != here:
                    os.chdir(here)
                if self.folder is not None:
                    self._leave(hidden, len(sys.modules) != known)
                aside.end()

    def _leave(self, hidden: dict[str, ModuleType | None], more: bool) -> None:
        """Take the folder's modules out of what everybody knows, and put back what they hid."""
        for name, module in list(sys.modules.items()) if more else ():
            if self.owns(getattr(module, "__file__", None) or ""):
                self.modules[name] = module
        for name in self.modules:
            sys.modules.pop(name, None)
            if (before := hidden.get(name)) is not None:
                sys.modules[name] = before
        if self.folder in sys.path:
            sys.path.remove(self.folder)

    def owns(self, file: str) -> bool:
        """Whether a file is the student's: in the folder, and neither installed nor ours."""
        if self.folder is None:
            return bool(self.root) and file.startswith(self.root)
        return file.startswith(os.path.join(self.folder, "")) and not is_installed(file)

    def blame(self, error: BaseException, otherwise: str) -> NoReturn:
        """Raise what is wrong where a student's code failed: at the deepest line that is its.

        otherwise : the place where none is. Who ends the program ends it from here, too.
        """
        trace = list(frames(error.__traceback__))
        if isinstance(error, KeyboardInterrupt) or (
            isinstance(error, SystemExit) and Path(trace[-1][0]).is_relative_to(OURS)
        ):
            raise error
        if isinstance(error, SyntaxError) and error.filename and self.owns(error.filename):
            place = f"{shown(error.filename)}:{error.lineno or 1}"
            raise FaultError(place, f"this is not Python: {error.msg}") from error
        own = [f"{shown(file)}:{line}" for file, line in trace if self.owns(file)]
        raise FaultError(own[-1] if own else otherwise, words_of(error)) from error


class HandedError(AttributeError):
    """What a student's code asked of a motion or a sensor, and what it could ask."""


def is_installed(file: str) -> bool:
    """Whether a file came with Python, with a package or with us."""
    real = os.path.realpath(file)
    return real.startswith(INSTALLED) or Path(real).is_relative_to(OURS)


def frames(trace: TracebackType | None) -> Iterator[tuple[str, int]]:
    """File and line of each frame that an exception went through, the deepest last."""
    while trace is not None:
        yield trace.tb_frame.f_code.co_filename, trace.tb_lineno
        trace = trace.tb_next


def words_of(error: BaseException) -> str:
    """An exception in a line: its kind and what it says; of ours only that."""
    try:
        text = " ".join(str(error)[: 10 * MOST_WORDS].split())
    except Exception:  # its class is the student's, and so is what makes a text of it
        text = ""
    if len(text) > MOST_WORDS:
        text = f"{text[:MOST_WORDS]}…"
    if isinstance(error, HandedError):
        return text
    if isinstance(error, SystemExit):
        return f"it calls exit({text}); a filter returns"
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def shown(file: str) -> str:
    """A file as it is told: from the folder that we are in, where it is below that; of a cell of a
    notebook, whose files are numbers, no more than that.

    >>> shown(os.path.abspath("mine.py"))
    'mine.py'
    """
    here = _here()
    if here is None:
        return os.path.basename(file)
    return "cell" if CELL.search(file) else file.removeprefix(os.path.join(here, ""))


def _here() -> str | None:
    """The folder that we are in; None where somebody has deleted it."""
    try:
        return os.getcwd()
    except FileNotFoundError:
        return None
