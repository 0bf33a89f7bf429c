"""What was handed in: whose it is, which file holds the filter, and what is in it."""

import hashlib
import os
import stat
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from ekfsim.errors import UsageError
from ekfsim.files.looking import exists, is_file, is_folder, read_from
from ekfsim.printable import in_a_line

MOST_NAME = 100  # bytes of a name in the name of a file
MOST_FILES = 2000  # of a folder that are looked at


@dataclass(frozen=True)
class Submission:
    """A file or a folder that was handed in."""

    path: Path
    name: str  # whose it is, as people are told

    @property
    def safe(self) -> str:
        """The name as it stands in the name of a file, told apart from every other."""
        return safe(self.name)

    def filter(self, wanted: str | None) -> tuple[str, str]:
        """Which file of it holds the filter; or "", and why there is none.

        wanted : the name that the homework has for it; None: the only .py
        """
        if is_file(self.path):
            return self.path.name, ""
        if wanted is not None:
            there = _plain(self.path / wanted)
            return (wanted, "") if there else ("", f"there is no {wanted} in the folder")
        found = sorted(path.name for path in self.path.glob("*.py") if _plain(path))
        if len(found) == 1:
            return found[0], ""
        if not found:
            return "", "there is no .py file in the folder"
        names = ", ".join(map(in_a_line, found[:4]))
        more = f" and {len(found) - 4} more" if len(found) > 4 else ""
        return "", f"there are several .py files: {names}{more}; hand in one, or name it as asked"

    @property
    def digest(self) -> str:
        """Its files, their names and contents, as a word."""
        whole = hashlib.sha256(self.name.encode(errors="surrogateescape"))
        for name, content in self._contents():
            whole.update(hashlib.sha256(name.encode(errors="surrogateescape")).digest())
            whole.update(content)
        return whole.hexdigest()

    def _contents(self) -> Iterator[tuple[str, bytes]]:
        if not is_folder(self.path):
            yield self.path.name, _digest(self.path)
            return
        paths = sorted(os.scandir(self.path), key=lambda entry: entry.name)
        seen, waiting = 0, list(reversed(paths))
        while waiting and seen < MOST_FILES:
            entry, seen = waiting.pop(), seen + 1
            name = os.path.relpath(entry.path, self.path)
            if entry.is_dir(follow_symlinks=False):
                inner = sorted(os.scandir(entry.path), key=lambda one: one.name, reverse=True)
                waiting += inner
            elif entry.is_file(follow_symlinks=False):
                yield name, _digest(Path(entry.path))
            else:
                yield name, b"link"


def submissions(paths: Sequence[Path]) -> list[Submission]:
    """What was handed in, by the names of whose it is.

    Raises UsageError where something is not there, and where two are of one name.
    """
    found: dict[str, Submission] = {}
    for path in paths:
        with read_from(path):
            if not exists(path):
                raise UsageError(f"{path}: no such file or folder")
            if not (is_file(path) or is_folder(path)):
                raise UsageError(f"{path}: is neither a file nor a folder")
            place = path if path.name not in ("", "..") else path.resolve()
            if is_file(path) and path.suffix != ".py":
                raise UsageError(f"{path}: is no .py file; name a filter, or the folder it is in")
        name = place.stem if is_file(path) else place.name
        key = unicodedata.normalize("NFC", name).casefold()
        if key in found:
            other = found[key].path
            raise UsageError(
                f"{path}: is called {in_a_line(name)}, as {other} is; results go by that name: "
                "rename one, or hand over the folders"
            )
        found[key] = Submission(path, name)
    return sorted(found.values(), key=lambda one: one.name)


def odd(found: Iterable[Submission]) -> Iterator[str]:
    """Folders of nothing but folders: each may be a class that was named as one submission."""
    for one in found:
        if not is_folder(one.path):
            continue
        with suppress(OSError), os.scandir(one.path) as entries:
            inside = [entry.is_dir() for entry in entries]
            if inside and all(inside):
                yield f"{one.path}: holds folders alone; if each is a submission, name {one.path}/*"


def safe(name: str) -> str:
    """A name in which every sign that may mean something in a path is written by its number.

    >>> safe("Zoë O'Hara/../x"), safe("..")
    ('Zo%C3%AB%20O%27Hara%2F..%2Fx', '%2E.')
    """
    told = quote(name, safe="", errors="surrogateescape")
    if told.startswith((".", "-", "~")):
        told = f"%{ord(told[0]):02X}{told[1:]}"
    if len(told) > MOST_NAME:
        told = f"{told[:MOST_NAME]}-{hashlib.sha256(name.encode(errors='replace')).hexdigest()[:8]}"
    return told


def _plain(path: Path) -> bool:
    """Whether there is a plain file, and no link to one that lies elsewhere."""
    try:
        return stat.S_ISREG(os.lstat(path).st_mode)
    except OSError:
        return False


def _digest(path: Path) -> bytes:
    """The contents of a file; what cannot be read is known by that alone."""
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").digest()
    except OSError:
        return b"unreadable"
