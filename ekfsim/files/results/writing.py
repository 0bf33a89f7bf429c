"""Results appear whole or not at all: written beside their place, then renamed to it."""

import errno
import io
import os
import re
import stat
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from ekfsim.errors import RunError, UsageError
from ekfsim.files.looking import current_folder, exists, is_folder
from ekfsim.files.results.partial import temporary_file, temporary_folder

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

UNWRITABLE = {
    *(errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOENT),
    *(errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENAMETOOLONG, errno.ELOOP, errno.EBUSY),
}


def refuse_existing(path: Path, force: bool) -> None:
    """Raise UsageError where a result stands already and `force` does not allow to replace it."""
    if special(path):
        return
    with told(path):
        if is_folder(path) and not path.is_symlink():
            raise UsageError(f"{path}: this is a folder; name a file")
        if exists(path) and not force:
            raise UsageError(
                f"{path}: exists already; choose another name, or replace it with --force"
            )


def refuse_unwritable(path: Path, force: bool) -> None:
    """Raise what `whole_file` would, before anything takes long: one is begun, and vanishes."""
    with _beside_for_now(path, force):
        pass


@contextmanager
def whole_file(path: Path, force: bool = False) -> Iterator[Path]:
    """The path of a temporary file that becomes `path` when the block ends well,
    and vanishes when it does not.

    Parents are made.
    A path that is no regular file (/dev/stdout) is handed out itself, to be written straight.

    Raises UsageError if a result exists and `force` is False, RunError if the disk refuses.
    """
    with _beside(path, force) as beside, told(path):
        yield beside


@contextmanager
def whole_text(path: Path, force: bool = False) -> Iterator[TextIO]:
    """The same, opened for text.
    Only what is written to this file is told as a refusal of this file.
    """
    with _beside(path, force) as beside, _opened(path, beside) as file:
        yield file
        file.flush()  # a full disk must show before the rename


def refuse_existing_folder(path: Path, *patterns: str, force: bool = False) -> Path:
    """Raise UsageError where `whole_folder` would;
    else where the folder is to lie, at the end of every link.
    """
    with told(path):
        place = Path(os.path.realpath(path))  # where a link leads: it stays a link
        if os.path.lexists(place) and not is_folder(place):
            raise UsageError(f"{path}: this is a file; name a folder")
        if place == current_folder():
            raise UsageError(f"{path}: this is the current folder; name a new one")
        _refuse_what_is_no_folder(path, place)
        held = sorted(place.iterdir()) if is_folder(place) else []
        if held and not force:
            raise UsageError(
                f"{path}: the folder is not empty; choose another, or replace what it holds "
                "with --force"
            )
        for file in held:
            if is_folder(file) or not any(map(file.match, patterns)):
                raise UsageError(
                    f"{path}: holds {file.name!r}, which is no result of ekfsim; choose "
                    "another folder"
                )
    return place


@contextmanager
def whole_folder(path: Path, *patterns: str, force: bool = False) -> Iterator[Path]:
    """A temporary folder that becomes `path` when the block ends well.

    With `force` an older result is replaced, but only if every file in it matches one of the
    `patterns`: what else lies in a folder is not ours to delete.

    Raises UsageError if the folder holds something and may not be replaced,
    RunError if the disk refuses.
    """
    place = refuse_existing_folder(path, *patterns, force=force)
    with _parents(path, place), told(path), temporary_folder(place) as beside:
        yield beside
        os.chmod(beside, 0o777 & ~_umask())
        refuse_existing_folder(path, *patterns, force=force)  # it may have come meanwhile
        if is_folder(place):
            with temporary_folder(place, is_first=False) as older:
                _exchange(place, beside, older / place.name)
        else:
            os.replace(beside, place)


def _exchange(place: Path, new: Path, older: Path) -> None:
    """Put the new folder in the place of the one that stands there, which moves to `older`; or
    leave all as it was.
    """
    try:
        os.replace(place, older)
        os.replace(new, place)
    except BaseException:
        if exists(older) and not exists(place):
            os.replace(older, place)
        raise


@contextmanager
def _beside_for_now(path: Path, force: bool) -> Iterator[Path]:
    """A temporary file beside `path`, which vanishes in any case; what is special is itself."""
    refuse_existing(path, force)
    if special(path):
        yield path
        return
    with _parents(path, path), ExitStack() as stack:
        with told(path):
            beside = stack.enter_context(temporary_file(path))
        yield beside


@contextmanager
def _beside(path: Path, force: bool) -> Iterator[Path]:
    """The temporary file of `whole_file`, whatever is told of the block."""
    with _beside_for_now(path, force) as beside:
        yield beside
        if beside == path:
            return
        with told(path):
            os.chmod(beside, 0o666 & ~_umask())  # a temporary file is its owner's alone
            refuse_existing(path, force)  # it may have come meanwhile
            os.replace(beside, path)


@contextmanager
def _parents(path: Path, place: Path) -> Iterator[None]:
    """The folders above a place;
    those that had to be made are removed again where nothing comes to lie in them.
    """
    with told(path):
        missing = [folder for folder in place.parents if not os.path.lexists(folder)]
    try:
        with told(path):
            _refuse_what_is_no_folder(path, place)
            place.parent.mkdir(parents=True, exist_ok=True)
        yield
    finally:
        for folder in missing:
            with suppress(OSError):  # it holds something
                folder.rmdir()


def _refuse_what_is_no_folder(path: Path, place: Path) -> None:
    """Raise UsageError where a result would lie below something that can hold none."""
    for folder in (*path.parents, *place.parents):
        if os.path.lexists(folder) and not is_folder(folder):
            raise UsageError(f"{path}: '{folder}' is no folder")


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Turn the disk's refusals into a sentence. A closed pipe is no failure and passes through."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as refusal:
        if refusal.errno == errno.ENOENT and current_folder() is None and not path.is_absolute():
            raise UsageError(
                f"{path}: cannot be written: the current folder was deleted; go to another"
            ) from refusal
        if refusal.errno in UNWRITABLE:
            raise UsageError(f"{path}: cannot be written: {refusal.strerror}") from refusal
        raise RunError(f"{path}: writing failed: {refusal.strerror}") from refusal


def special(path: Path) -> bool:
    """Whether a path is no place for a result to be put in,
    but a way to where it is written straight.
    """
    # even where standard output is a regular file: nothing may take its place
    if _descriptor(path) is not None:
        return True
    try:
        mode = path.stat().st_mode
    except OSError:  # whoever goes on to write there is told
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


@contextmanager
def _opened(path: Path, beside: Path) -> Iterator[TextIO]:
    """A file to write the text of `path` to;
    one that is open already, as /dev/stdout, goes on where it is.
    """
    descriptor = _descriptor(beside)
    with told(path):
        raw = _Told(path, beside if descriptor is None else os.dup(descriptor))
    file = io.TextIOWrapper(
        io.BufferedWriter(raw), encoding="utf-8", errors="replace", newline="\n"
    )
    with file:
        yield file


class _Told(io.FileIO):
    """A file whose refusals are told under the name that the user gave it."""

    def __init__(self, path: Path, opened: Path | int) -> None:
        super().__init__(opened, "w")
        self._path = path

    def write(self, data: "ReadableBuffer", /) -> int | None:  # type: ignore[override]  # None where it would block
        """As any file does."""
        with told(self._path):
            return super().write(data)


def _descriptor(path: Path) -> int | None:
    """The number of the open file that /dev/stdout,
    /dev/fd/3 and their like stand for; None for any other path.
    """
    name = os.path.normpath((current_folder() or Path("/")) / path)
    numbered = re.fullmatch(r"/(?:dev|proc/self)/fd/(\d+)", name)
    return int(numbered[1]) if numbered else {"/dev/stdout": 1, "/dev/stderr": 2}.get(name)


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
