"""The documents' systems, and how each is watched: by which filter, and what it is given."""

from collections.abc import Iterable
from dataclasses import dataclass

from ekfsim.filters.choice import begun
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.filters.variants.listing import ListingEKF
from ekfsim.records import Entry
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument
from ekfsim.systems.instruments import (
    Gnss,
    Infrared,
    Markers,
    Pylon,
    RangeBearings,
    Ranges,
    Ultrasonic,
)
from ekfsim.systems.interpolation import stretched
from ekfsim.systems.robot import Robot
from ekfsim.systems.robots import (
    GnssMower,
    IRobotCreate,
    Mower,
    Pioneer,
    PylonCart,
    RangingMower,
)
from ekfsim.systems.system import System


@dataclass(frozen=True)
class Documented(System):
    """One of the documents' systems: its robot and its instruments, each default the document's
    number; and where the code of its authors goes another way than their text.
    """

    robot: Robot
    instruments: tuple[Instrument, ...]
    listed: bool = False  # their EKF holds readings against the state of before the motion
    fix_per_input: bool = False  # they have a fix at every motion input

    def filter(self, name: str, reading: DocumentReading, beginning: Beginning) -> Filter:
        """The filter of that name, at the beginning of a run; `coded`, that of the listing."""
        if self.by_listing(name, reading):
            return ListingEKF.begin(beginning)
        return begun(name, beginning)

    def entries(self, entries: Iterable[Entry], reading: DocumentReading) -> Iterable[Entry]:
        """What the filter is given of what happened; `coded`, what that of the authors is given."""
        return stretched(entries) if self.fix_per_input and reading == "coded" else entries

    def by_listing(self, name: str, reading: DocumentReading) -> bool:
        """Whether the filter of that name is that of the authors' listing."""
        return self.listed and name == "ekf" and reading == "coded"


SYSTEMS: dict[str, Documented] = {
    "mower": Documented(Mower(), (Markers(),), listed=True),
    "pioneer": Documented(Pioneer(), (Ultrasonic(), Infrared())),
    "gnss": Documented(GnssMower(), (Gnss(),), listed=True, fix_per_input=True),
    "pylon": Documented(PylonCart(), (Pylon(),)),
    "landmarks": Documented(IRobotCreate(), (RangeBearings(),)),
    "ranges": Documented(RangingMower(), (Ranges(),)),
}
