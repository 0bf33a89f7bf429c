"""What a reader makes of a recorded log."""

from dataclasses import dataclass

from ekfsim.records import Log
from ekfsim.systems.instrument import Landmark


@dataclass(frozen=True)
class Recorded:
    """A log that was read, and what its reader must be told of it."""

    log: Log
    # where the log's own files say what stands where, else None
    landmarks: tuple[Landmark, ...] | None
    warnings: list[str]  # each a line: file:line: what was odd, and what was made of it
