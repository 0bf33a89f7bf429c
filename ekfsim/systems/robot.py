"""What every robot offers to a filter and a simulation."""

from collections.abc import Mapping
from typing import NamedTuple, Protocol

from ekfsim.geometry import Array
from ekfsim.models.layout import Layout
from ekfsim.models.protocols import Motion
from ekfsim.systems.document import DocumentReading

Entries = Mapping[str, int]


class Tick(NamedTuple):
    """A true motion between two readings of the wheels. Arrays carry leading axes (…)."""

    before: Array  # (…, 3) true pose in m, m, rad
    after: Array  # (…, 3)
    distance: Array  # (…) m along the way
    turn: Array  # (…) rad
    velocity_before: Array  # (…, 2) m/s in the world's frame, during this tick
    velocity_after: Array  # (…, 2) and in the next
    dt: float  # s


class Gps(NamedTuple):
    """A receiver of satellites whose fixes are recorded, and which no filter is given."""

    sigma: float  # m, on each axis
    period: float  # s


class Robot(Protocol):
    """What a filter and a simulation need to know of a robot."""

    @property
    def readings(self) -> tuple[DocumentReading, ...]:
        """In which other equations than the corrected ones it is followed."""

    @property
    def faults(self) -> Entries:
        """Which of DriveFaults it may have, each with the entry of u that it is about."""

    @property
    def over(self) -> Entries:
        """Those of them that are rates of an entry which adds up, with the entry of its time."""

    @property
    def gps(self) -> Gps | None:
        """A receiver that is recorded and not used."""

    @property
    def rate(self) -> float:
        """Motion inputs per second."""

    @property
    def layout(self) -> Layout:
        """What the entries of the filter's state are."""

    def motion(self, reading: DocumentReading) -> Motion:
        """The motion model of the filter."""

    def first_covariance(self, reading: DocumentReading) -> Array:
        """P₀ : (n, n), as the document has it."""

    def ideal(self, tick: Tick) -> Array:
        """The motion input u : (…, m) that a true motion gives, without noise."""
