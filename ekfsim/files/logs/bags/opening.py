"""A path → a bag that is open, read by the package rosbags."""

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ekfsim.errors import UsageError
from ekfsim.files.foreign import of_folder
from ekfsim.files.looking import exists, is_folder, read_from
from ekfsim.late import found

DESCRIPTION = "metadata.yaml"  # of the files of a bag of ROS 2, beside them
KINDS = (".bag", ".mcap", ".db3")
HOLDS = "a .bag of ROS 1, a folder of ROS 2 with its metadata.yaml, an .mcap or a .db3"
MISSING = "bags need the package 'rosbags': pip install 'ekfsim[bags]'"
MOST = 200  # characters of what rosbags says, which may be a whole definition
MENDED = {  # what mends a bag whose recording was cut off
    ".bag": "`rosbag reindex`",
    ".mcap": "`mcap recover`",
    "": "`ros2 bag reindex`",
}


class Opened:
    """A bag that is open."""

    def __init__(self, path: Path, reader: Any) -> None:
        self._path, self._reader = path, reader
        # topics of no message do not count: recorders write down all that was offered
        self.connections = [one for one in reader.connections if one.msgcount]

    def messages(self, topics: Collection[str]) -> Iterator[tuple[str, int, Any]]:
        """Topic, when the bag received it in ns, and what each message of some topics says.

        Raises UsageError where the bag is broken.
        """
        chosen = [one for one in self.connections if one.topic in topics]
        if not chosen:  # for which rosbags reads all
            return
        with told(self._path):
            messages = self._reader.messages(connections=chosen)
        while True:
            with told(self._path):
                connection, received, raw = next(messages, (None, 0, b""))
            if connection is None:
                return
            with told(self._path, f"a message of {connection.topic} ({connection.msgtype})"):
                message = self._reader.deserialize(raw, connection.msgtype)
            yield connection.topic, received, message


@contextmanager
def opened(path: Path) -> Iterator[Opened]:
    """A bag, which is closed again.

    Raises UsageError where there is no bag, where it is broken, or where rosbags is missing.
    """
    try:
        reader = found("rosbags.highlevel:AnyReader")
        stores, typestore = found("rosbags.typesys:Stores"), found("rosbags.typesys:get_typestore")
    except ImportError:
        raise UsageError(f"{path}: {MISSING}") from None
    bag = _bag(path)
    with told(bag):  # of messages whose definitions the bag does not hold, those of ROS 2 are taken
        inside = reader([bag], default_typestore=typestore(stores.LATEST))
        inside.open()
    try:
        yield Opened(bag, inside)
    finally:
        inside.close()


@contextmanager
def told(bag: Path, what: str = "it") -> Iterator[None]:
    """Tell in a sentence why rosbags cannot read something. Nothing of ours runs inside: bytes that
    are no bag make it raise whatever its parts do, of KeyError and struct.error to MemoryError.

    Raises UsageError.
    """
    try:
        yield
    except Exception as error:
        why = " ".join(str(error).split())[:MOST] or type(error).__name__
        right = f"one that was cut off is mended by {MENDED.get(bag.suffix, MENDED[''])}"
        raise UsageError(
            f"{bag}: rosbags cannot read {what}: {why}; {right}; wanted is {HOLDS}"
        ) from None


def _bag(path: Path) -> Path:
    """The bag that is meant: the path itself, or the one file in a folder without a description."""
    with read_from(path):
        if not exists(path):
            raise UsageError(f"{path}: no such file or folder; name {HOLDS}")
        if path.name == DESCRIPTION:
            return path.parent
        if not is_folder(path) or exists(path / DESCRIPTION):
            return path
        names = sorted(os.listdir(path))
        inside = [path / name for name in names if Path(name).suffix in KINDS]
    if len(inside) == 1:
        return inside[0]
    if inside:
        listed = ", ".join(file.name for file in inside[:4])
        raise UsageError(f"{path}: several bags in it: {listed}; name {HOLDS}")
    other = of_folder(names, str(path))
    here = f"here is {other.what}: {other.cure}" if other else f"name {HOLDS}"
    raise UsageError(f"{path}: no bag in it; {here}")
