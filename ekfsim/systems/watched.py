"""How a system is watched: which filter a name stands for, and what of the log it is given."""

from collections.abc import Iterable
from dataclasses import dataclass

from ekfsim.filters.choice import begun
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.filters.variants.listing import ListingEKF
from ekfsim.records import Entry
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument
from ekfsim.systems.interpolation import stretched
from ekfsim.systems.robots import Robot


class System:
    """What is watched as it stands: the classroom's robot, of which there is no more to say."""

    def filter(self, name: str, reading: DocumentReading, beginning: Beginning) -> Filter:
        """The filter of that name, at the beginning of a run."""
        return begun(name, beginning)

    def entries(self, entries: Iterable[Entry], reading: DocumentReading) -> Iterable[Entry]:
        """What the filter is given of what happened."""
        return entries

    def by_listing(self, name: str, reading: DocumentReading) -> bool:
        """Whether the filter of that name holds readings against the state of before the motion."""
        return False


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
