"""Questions to the file system: whether something is there, and what.

`Path.exists` and its like raise for some refusals and answer no to others, in each version of
Python for others. Here every refusal raises, and whoever asks says in a `with` how it is told:
`read_from` here, `told` of what is written.
"""

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ekfsim.errors import UsageError


def exists(path: Path) -> bool:
    """Whether a path leads to anything. Raises OSError where that may not be looked at."""
    return _mode(path) is not None


def is_folder(path: Path) -> bool:
    """Whether a path leads to a folder. Raises OSError where that may not be looked at."""
    return stat.S_ISDIR(_mode(path) or 0)


def is_file(path: Path) -> bool:
    """Whether a path leads to a regular file. Raises OSError where that may not be looked at."""
    return stat.S_ISREG(_mode(path) or 0)


def _mode(path: Path) -> int | None:
    try:
        return os.stat(path).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


# what came out of pipes, by device, number and last change of each
_taken: dict[tuple[int, int, int], bytes] = {}


def contents(path: Path, most: int) -> bytes:
    """At most so many bytes and one of a file;
    of a pipe, which can be read once only, also when asked again.

    Raises OSError where it cannot be read.
    """
    found = os.stat(path)
    if stat.S_ISREG(found.st_mode):
        with open(path, "rb") as file:
            return file.read(most + 1)
    if (taken := _taken.get(_key(found))) is None:
        with open(path, "rb") as file:
            taken = file.read(most + 1)
            _taken[_key(os.fstat(file.fileno()))] = taken
    return taken


def _key(found: os.stat_result) -> tuple[int, int, int]:
    return found.st_dev, found.st_ino, found.st_mtime_ns


@contextmanager
def read_from(path: str | Path) -> Iterator[None]:
    """Tell in a sentence why something cannot be read. Raises UsageError."""
    try:
        yield
    except (OSError, ValueError) as refusal:  # ValueError: a NUL in the name
        raise UsageError(
            f"{path}: cannot be read: {getattr(refusal, 'strerror', None) or refusal}"
        ) from None


def current_folder() -> Path | None:
    """The current folder, None where it was deleted."""
    try:
        return Path.cwd()
    except FileNotFoundError:
        return None
