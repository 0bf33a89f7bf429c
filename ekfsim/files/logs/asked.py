"""What the reader of a log is asked for."""

from pathlib import Path
from typing import NamedTuple

from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World


class Asked(NamedTuple):
    """A log to be read, for the robot and the instruments of a world."""

    path: Path  # a file or a folder, as the format has it
    world: World
    reading: DocumentReading  # of the system's document
    recording: RecordingKeys  # the format, and what the commands file says of units and columns
    warnings: list[str]  # what is odd in the log, as it is found
