"""Where a result is written until it is whole: a hidden place beside its own, locked for as long as
somebody is at it.

A lock ends with its process, however that ends,
and no number of a process tells so much: it may be another's by now.
"""

import errno
import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from platform import node
from tempfile import mkdtemp, mkstemp

LONGEST = 100  # bytes of a result's name that stand in that of its temporary place: a name has 255
RANDOM = "[a-z0-9_]{8}"  # what `tempfile` puts into a name
# locks of another machine may not be seen from here
HOST = re.sub(r"\W", "", node())[:20]


@contextmanager
def temporary_file(place: Path) -> Iterator[Path]:
    """A new file beside a place; it vanishes unless it is moved.

    Raises OSError where none can be made, or another process is writing to the same place (EBUSY).
    """
    descriptor, name = mkstemp(prefix=_prefix(place), suffix=".partial", dir=place.parent)
    beside = Path(name)
    try:
        _lock(descriptor)
        _clear(place, beside)
        yield beside
    finally:
        beside.unlink(missing_ok=True)
        os.close(descriptor)


@contextmanager
def temporary_folder(place: Path, is_first: bool = True) -> Iterator[Path]:
    """The same for a folder.
    is_first : no, where this process has another one beside the place already
    """
    beside = Path(mkdtemp(prefix=_prefix(place), suffix=".partial", dir=place.parent))
    descriptor = _opened(beside)
    try:
        if descriptor is not None:
            _lock(descriptor)
        if is_first:
            _clear(place, beside)
        yield beside
    finally:
        shutil.rmtree(beside, ignore_errors=True)
        if descriptor is not None:
            os.close(descriptor)


def _prefix(place: Path) -> str:
    return f".{os.fsdecode(os.fsencode(place.name)[:LONGEST])}.{HOST}."


def _clear(place: Path, own: Path) -> None:
    """Remove what killed processes left beside a place.
    Raises OSError where a living one is at work there.
    """
    ours = re.compile(f"{re.escape(_prefix(place))}{RANDOM}\\.partial")
    for name in os.listdir(place.parent):
        left = place.parent / name
        if name == own.name or not ours.fullmatch(name):
            continue
        descriptor = _opened(left)
        if descriptor is None:
            continue
        try:
            if _lock(descriptor):
                _remove(left, place)
        except BlockingIOError:
            why = "another run is at work there; wait for it, or choose another name"
            raise OSError(errno.EBUSY, why) from None
        finally:
            os.close(descriptor)


def _remove(left: Path, place: Path) -> None:
    """Remove a leftover;
    an older result that was just making way in it for a newer one goes back to its place.
    """
    with suppress(OSError):
        older = left / place.name
        if older.is_dir() and not place.exists():
            os.replace(older, place)
    if left.is_dir():
        shutil.rmtree(left, ignore_errors=True)
    else:
        left.unlink(missing_ok=True)


def _opened(path: Path) -> int | None:
    """A descriptor by which a file or a folder can be locked; None where the system has none."""
    try:
        return os.open(path, os.O_RDONLY)
    except OSError:
        return None


def _lock(descriptor: int) -> bool:
    """Whether what is open could be locked;
    some systems lock nothing. Raises BlockingIOError where another has it.
    """
    try:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except (ImportError, OSError):
        return False
    return True
