"""How any system is watched: which filter a name stands for, and what of the log it is given."""

from collections.abc import Iterable

from ekfsim.filters.choice import begun
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.records import Entry
from ekfsim.systems.document import DocumentReading


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
