"""The files of a log, found by their names."""

import os
from pathlib import Path

from ekfsim.errors import UsageError


def folder_of(path: Path, holds: str) -> Path:
    """The folder of a log. Raises UsageError, saying what it `holds`, where there is none."""
    if not path.exists():
        raise UsageError(f"{path}: no such folder; name the one that holds {holds}")
    if not path.is_dir():
        raise UsageError(f"{path}: is a file; name the folder that holds {holds}")
    return path


def find(folder: Path, what: str, *patterns: str) -> Path:
    """The one file in a folder whose name fits, the first pattern that fits any.

    Raises UsageError where there is none, or more than one.
    """
    found = find_any(folder, what, *patterns)
    if found is None:
        raise UsageError(f"{folder}: no file {_either(patterns)} in it; it would hold {what}")
    return found


def find_any(folder: Path, what: str, *patterns: str) -> Path | None:
    """The same for a file that a log may lack."""
    try:
        for pattern in patterns:
            found = sorted(path for path in folder.glob(pattern) if not path.name.startswith("."))
            if len(found) > 1:
                names = ", ".join(path.name for path in found)
                raise UsageError(f"{folder}: several files '{pattern}' in it: {names}; leave one there for {what}")
            if found:
                return found[0]
    except OSError as error:
        raise UsageError(f"{folder}: cannot be read: {error.strerror or error}") from None
    return None


def table_file(path: Path, what: str, extension: str) -> Path:
    """A file that is named itself, or by the folder that holds it and no other of its kind."""
    if not os.path.lexists(path):
        raise UsageError(f"{path}: no such file; name {what}, or the folder that holds it")
    return find(path, what, f"*{extension}") if path.is_dir() else path


def _either(patterns: tuple[str, ...]) -> str:
    return " or ".join(f"'{pattern}'" for pattern in patterns)
