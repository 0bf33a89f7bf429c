"""The files of a log, found by their names."""

import os
from fnmatch import fnmatchcase
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.foreign import ENOUGH, of_bytes, of_folder
from ekfsim.files.looking import contents, exists, is_file, is_folder, read_from

LISTED = 6  # files of a folder that are named where the one that is wanted is not there


def folder_of(path: Path, holds: str) -> Path:
    """The folder of a log. Raises UsageError, saying what it `holds`, where there is none."""
    with read_from(path):
        if not exists(path):
            raise UsageError(f"{path}: no such folder; name the one that holds {holds}")
        if is_folder(path):
            return path
    raise UsageError(f"{path}: is a file; name the folder that holds {holds}")


def refuse_foreign(path: Path) -> None:
    """Raise UsageError where a path names a bag, a picture, an archive: none is read here."""
    with read_from(path):
        foreign = of_bytes(contents(path, ENOUGH)) if is_file(path) else None
    if foreign is not None:
        raise UsageError(f"{path}: this is {foreign.what}, no text; {foreign.cure}")


def find(folder: Path, what: str, *patterns: str, cure: str = "") -> Path:
    """The one file in a folder whose name fits, the first pattern that fits any.
    cure : what else can be done where none does

    Raises UsageError where there is none, or more than one.
    """
    found = find_any(folder, what, *patterns)
    if found is None:
        raise missing(folder, what, *patterns, cure=cure)
    return found


def missing(folder: Path, what: str, *patterns: str, cure: str = "") -> UsageError:
    """What is told of a folder without the file that is wanted: what there is in its place."""
    with read_from(folder):
        names = sorted(name for name in os.listdir(folder) if not name.startswith("."))
    wrong = f"{folder}: no file {_either(patterns)} in it; it would hold {what}"
    if other := of_folder(names, str(folder)):
        return UsageError(f"{wrong}; here is {other.what}: {other.cure}")
    some = ", ".join([*names[:LISTED], *(["…"] if len(names) > LISTED else [])])
    return UsageError(f"{wrong}; found {some or 'nothing'}{f'; {cure}' if cure else ''}")


def find_any(folder: Path, what: str, *patterns: str) -> Path | None:
    """The same for a file that a log may lack."""
    with read_from(folder):
        names = sorted(name for name in os.listdir(folder) if not name.startswith("."))
    for pattern in patterns:
        found = [name for name in names if fnmatchcase(name, pattern)]
        if len(found) > 1:
            names_of_some = ", ".join([*found[:3], *(["…"] if len(found) > 3 else [])])
            raise UsageError(
                f"{folder}: several files '{pattern}' in it: {names_of_some}; leave one there "
                f"for {what}"
            )
        if found:
            return folder / found[0]
    return None


def table_file(path: Path, what: str, extension: str) -> Path:
    """A file that is named itself, or by the folder that holds it and no other of its kind."""
    with read_from(path):
        if not exists(path):
            raise UsageError(f"{path}: no such file; name {what}, or the folder that holds it")
        holds = is_folder(path)
    return find(path, what, f"*{extension}") if holds else path


def _either(patterns: tuple[str, ...]) -> str:
    return " or ".join(f"'{pattern}'" for pattern in patterns)
