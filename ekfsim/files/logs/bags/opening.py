"""A path → a reader of the package rosbags."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ekfsim.errors import UsageError
from ekfsim.files.looking import exists, is_folder, read_from
from ekfsim.late import found

KINDS = (".bag", ".mcap", ".db3")
HOLDS = "a .bag of ROS 1, a folder of ROS 2 with its metadata.yaml, an .mcap or a .db3"
MISSING = "bags need the package 'rosbags': pip install 'ekfsim[bags]'"


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """An `AnyReader` of a bag, which is closed again.

    Raises UsageError where there is no bag, where it is broken, or where rosbags is missing.
    """
    try:
        reader, broken = (
            found("rosbags.highlevel:AnyReader"),
            found("rosbags.highlevel:AnyReaderError"),
        )
        stores, typestore = found("rosbags.typesys:Stores"), found("rosbags.typesys:get_typestore")
    except ImportError:
        raise UsageError(f"{path}: {MISSING}") from None
    bag = _bag(path)
    try:  # of messages whose definitions the bag does not hold, those of ROS 2 are taken
        with read_from(bag), reader([bag], default_typestore=typestore(stores.LATEST)) as opened:
            yield opened
    except broken as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise UsageError(f"{bag}: rosbags cannot read it: {why}; name {HOLDS}") from None


def _bag(path: Path) -> Path:
    """The bag that is meant: the path itself, or the one file in a folder without a description."""
    with read_from(path):
        if not exists(path):
            raise UsageError(f"{path}: no such file or folder; name {HOLDS}")
        if not is_folder(path) or exists(path / "metadata.yaml"):
            return path
        inside = sorted(file for file in path.iterdir() if file.suffix in KINDS)
    if len(inside) == 1:
        return inside[0]
    names = f"several bags in it: {', '.join(file.name for file in inside[:4])}" if inside else ""
    raise UsageError(f"{path}: {names or 'no bag in it'}; name {HOLDS}")
