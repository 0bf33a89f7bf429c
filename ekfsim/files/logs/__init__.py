"""Recorded logs: text files of other programs, or of `ekfsim record`, ↔ Entries."""

from collections.abc import Callable
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.recording import BAG, SYSTEM_OF, RecordingKeys, misfit
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.bags.bag import read_bag
from ekfsim.files.logs.bags.declared import BAGS
from ekfsim.files.logs.folder import refuse_foreign
from ekfsim.files.logs.formats.classroom import CLASSROOM, read_classroom
from ekfsim.files.logs.formats.gnss import GNSS, read_gnss
from ekfsim.files.logs.formats.mower import MOWER, read_mower
from ekfsim.files.logs.formats.mrclam import read_mrclam
from ekfsim.files.logs.formats.mrclam_tables import MRCLAM
from ekfsim.files.logs.formats.pioneer import PIONEER, read_pioneer
from ekfsim.files.logs.formats.pylon import PYLON, read_pylon
from ekfsim.files.logs.formats.ranges import PLAZA, read_ranges
from ekfsim.files.logs.named.declared import LOG
from ekfsim.files.logs.named.log import read_named
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.tables.declared import Format
from ekfsim.files.logs.writing.own import WRITERS
from ekfsim.files.logs.writing.written import write_log
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World

__all__ = ["DECLARED", "FORMATS", "SYSTEM_OF", "WRITERS", "Recorded", "read_log", "write_log"]

Reader = Callable[[Asked], Recorded]
FORMATS: dict[str, Reader] = {
    "pylon": read_pylon,
    "gnss": read_gnss,
    "mower": read_mower,
    "mrclam": read_mrclam,
    "ranges": read_ranges,
    "pioneer": read_pioneer,
    "classroom": read_classroom,
    "log": read_named,
    "bag": read_bag,
}
# what the files of each hold, for readers, refusals, `ekfsim schema recording` and the docs
DECLARED: dict[str, Format] = {
    format.name: format
    for format in (LOG, BAGS, PYLON, GNSS, MOWER, MRCLAM, PLAZA, PIONEER, CLASSROOM)
}


def read_log(
    recording: RecordingKeys,
    path: Path,
    world: World,
    reading: DocumentReading,
    warnings: list[str] | None = None,
) -> Recorded:
    """The log that a file or a folder holds, for the robot and the instruments of a world.

    `warnings` gets what is odd in the log as it is found, and so holds it where the reading ends in
    a mistake, too. Raises UsageError where a file is missing or the world is another system's,
    InputError with what is wrong in a file.
    """
    format = recording.format
    if (system := misfit(format, world.system)) is not None:
        wrong = f"a log of the format {format} belongs to a world with system: {system}"
        raise UsageError(f"{path}: {wrong}; {world.name!r} has system: {world.system}")
    if format != BAG:
        refuse_foreign(path)
    found = [] if warnings is None else warnings
    return FORMATS[format](Asked(path, world, reading, recording, found))
