"""Results appear whole or not at all: written beside their place, then renamed to it."""

import errno
import os
import re
import shutil
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp, mkstemp
from typing import TextIO

from ekfsim.errors import RunError, UsageError


def refuse_existing(path: Path, force: bool) -> None:
    """Raise UsageError where a result stands already and `force` does not allow to replace it."""
    if special(path):
        return
    with told(path):
        if path.is_dir() and not path.is_symlink():
            raise UsageError(f"{path}: this is a folder; name a file")
        if path.exists() and not force:
            raise UsageError(f"{path}: exists already; choose another name, or replace it with --force")


@contextmanager
def whole_file(path: Path, force: bool = False) -> Iterator[Path]:
    """The path of a temporary file that becomes `path` when the block ends well, and vanishes when it does not.

    Parents are made. A path that is no regular file (/dev/stdout) is handed out itself, to be written straight.

    Raises UsageError if a result exists and `force` is False, RunError if the disk refuses.
    """
    refuse_existing(path, force)
    if special(path):
        with told(path):
            yield path
        return
    with told(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor, name = mkstemp(prefix=f".{path.name[:100]}.", suffix=".partial", dir=path.parent)
        os.close(descriptor)
    beside = Path(name)
    try:
        with told(path):
            yield beside
            os.chmod(beside, 0o666 & ~_umask())  # mkstemp makes files that only their owner reads
            os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


@contextmanager
def whole_text(path: Path, force: bool = False) -> Iterator[TextIO]:
    """The same, opened for text."""
    with whole_file(path, force) as beside, _opened(beside) as file:
        yield file
        file.flush()  # a full disk must show before the rename


@contextmanager
def whole_folder(path: Path, pattern: str, force: bool = False) -> Iterator[Path]:
    """A temporary folder that becomes `path` when the block ends well.

    With `force` an older result is replaced, but only if every file in it matches `pattern`: what else lies in a
    folder is not ours to delete.

    Raises UsageError if the folder holds something and may not be replaced, RunError if the disk refuses.
    """
    if path.exists() and not path.is_dir():
        raise UsageError(f"{path}: this is a file; name a folder")
    held = sorted(path.iterdir()) if path.is_dir() else []
    if held and not force:
        raise UsageError(f"{path}: the folder is not empty; choose another, or replace its pictures with --force")
    for file in held:
        if file.is_dir() or not file.match(pattern):
            raise UsageError(f"{path}: holds {file.name!r}, which is no result of ekfsim; choose another folder")
    with told(path):
        path.absolute().parent.mkdir(parents=True, exist_ok=True)
        beside = Path(mkdtemp(prefix=f".{path.name[:100]}.", suffix=".partial", dir=path.absolute().parent))
    try:
        with told(path):
            yield beside
            os.chmod(beside, 0o777 & ~_umask())
            if path.is_dir():
                for file in held:
                    file.unlink()
                path.rmdir()
            os.replace(beside, path)
    finally:
        shutil.rmtree(beside, ignore_errors=True)


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Turn the disk's refusals into a sentence. A closed pipe is no failure and passes through."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as refusal:
        if refusal.errno in (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOTDIR, errno.ENAMETOOLONG):
            raise UsageError(f"{path}: cannot be written: {refusal.strerror}") from refusal
        raise RunError(f"{path}: writing failed: {refusal.strerror}") from refusal


def special(path: Path) -> bool:
    """Whether a path is no place for a result to be put in, but a way to where it is written straight."""
    if _descriptor(path) is not None:  # even where standard output is a regular file: nothing may take its place
        return True
    try:
        mode = path.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def _opened(path: Path) -> TextIO:
    """A file to write text to; one that is open already, as /dev/stdout, goes on where it is."""
    descriptor = _descriptor(path)
    return open(path if descriptor is None else os.dup(descriptor), "w", encoding="utf-8", newline="\n")


def _descriptor(path: Path) -> int | None:
    """The number of the open file that /dev/stdout, /dev/fd/3 and their like stand for; None for any other path."""
    name = os.path.abspath(path)
    numbered = re.fullmatch(r"/(?:dev|proc/self)/fd/(\d+)", name)
    return int(numbered[1]) if numbered else {"/dev/stdout": 1, "/dev/stderr": 2}.get(name)


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
