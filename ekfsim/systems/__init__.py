"""The systems of the documents, put together: what each robot measures of its motion, and what its instruments read.

SYSTEMS names them. The classroom has no entry: its robot obeys commands one by one (see `simulation`).
"""

from dataclasses import dataclass

from ekfsim.systems.instruments import (
    Bearings,
    Gnss,
    Infrared,
    Instrument,
    Markers,
    Pylon,
    RangeBearings,
    Ranges,
    Ultrasonic,
)
from ekfsim.systems.robots import GnssMower, IRobotCreate, Mower, Pioneer, PylonCart, RangingMower, Robot


@dataclass(frozen=True)
class System:
    """One of the documents' systems: its robot and its instruments, each default the document's number."""

    robot: Robot
    instruments: tuple[Instrument, ...]


SYSTEMS: dict[str, System] = {
    "mower": System(Mower(), (Markers(),)),
    "pioneer": System(Pioneer(), (Ultrasonic(), Infrared())),
    "gnss": System(GnssMower(), (Gnss(),)),
    "pylon": System(PylonCart(), (Pylon(),)),
    "landmarks": System(IRobotCreate(), (RangeBearings(),)),
    "ranges": System(RangingMower(), (Ranges(),)),
}
INSTRUMENTS: dict[str, type[Instrument]] = {
    kind.name: kind for kind in (Markers, RangeBearings, Ranges, Bearings, Gnss, Pylon, Ultrasonic, Infrared)
}
