"""A bag → a recorded log."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.keys.columns import MotionKeys, ReadingsKeys, TableKeys
from ekfsim.files.keys.recording import RecordingKeys
from ekfsim.files.keys.topics import TopicsKeys
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.bags.opening import opened
from ekfsim.files.logs.bags.tables import tables_of, topics_read
from ekfsim.files.logs.bags.topics import topics_of
from ekfsim.files.logs.named.log import read_tables
from ekfsim.files.logs.named.tables import Source
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.text import Lines
from ekfsim.systems.instrument import Instrument
from ekfsim.world import World

SENSORS = {  # by the kinds that can read what a topic tells
    "fix": ("gnss",),
    "scan": ("ultrasonic",),
    "landmarks": ("rangeBearing", "range", "bearing"),
}


@dataclass(frozen=True)
class Bag:
    """The tables of a bag, as those of any log."""

    path: Path
    recording: RecordingKeys
    tables: dict[str, Lines]  # by what they tell
    sensors: dict[str, str]  # which sensor each reading is of

    @property
    def no_truth(self) -> str:
        """Which topic is not named."""
        return "no topic is named for the true poses (topics: {truth: …})"

    def motion(self) -> tuple[Source, MotionKeys]:
        """What the robot did; speeds are told at the beginning of the time that they hold for."""
        return self._source("motion"), MotionKeys()

    def readings(self) -> list[tuple[Source, ReadingsKeys]]:
        """What the sensors told."""
        return [
            (self._source(role), ReadingsKeys(sensor=sensor))
            for role, sensor in self.sensors.items()
        ]

    def landmarks(self) -> None:
        """A bag tells no places of landmarks: they are the world's."""

    def truth(self) -> Source | None:
        """The true poses, None where no topic is named for them."""
        return self._source("truth") if "truth" in self.tables else None

    def _source(self, role: str) -> Source:
        return Source(self.path, TableKeys(), self.recording, self.tables[role])


def read_bag(asked: Asked) -> Recorded:
    """What its topics tell, by the stamps of their messages.

    Raises UsageError where there is no bag, or where a topic is not there; InputError with what is
    wrong in the numbers.
    """
    path, world, _, recording, warnings = asked
    with opened(path) as reader:
        topics = recording.topics or TopicsKeys()
        chosen = topics_of(reader.connections, topics, path, warnings)
        instruments = _instruments(chosen, topics, world, path, warnings)
        chosen = {
            role: topic
            for role, topic in chosen.items()
            if role not in SENSORS or role in instruments
        }
        read = topics_read(reader, chosen)
    tables = tables_of(read, _bearings(instruments), recording.origin, path, warnings)
    sensors = {role: instrument.called for role, instrument in instruments.items()}
    return read_tables(asked, Bag(path, recording, tables, sensors))


def _instruments(
    chosen: dict[str, str], asked: TopicsKeys, world: World, path: Path, warnings: list[str]
) -> dict[str, Instrument]:
    """The sensor of the world that each topic is of. Raises UsageError where a topic was named, and
    the world has no sensor for it; of another a warning tells.
    """
    found = dict[str, Instrument]()
    for role, kinds in SENSORS.items():
        if role not in chosen:
            continue
        fit = [one for one in world.told_instruments if one.name in kinds]
        if fit:
            found[role] = fit[0]
            continue
        wrong = (
            f"{path}: topics.{role}: the world {world.name!r} has no sensor {' or '.join(kinds)}"
        )
        right = f"write sensors: [{{{kinds[0]}: {{}}}}] in it"
        if getattr(asked, role) is not None:
            raise UsageError(f"{wrong}; {right}")
        warnings.append(f"{wrong}: {chosen[role]} is not read; {right}")
    return found


def _bearings(instruments: dict[str, Instrument]) -> Sequence[float]:
    """Where the beams point that scans are thinned to, in rad."""
    bearings: Sequence[float] = getattr(instruments.get("scan"), "bearings", ())
    return bearings
