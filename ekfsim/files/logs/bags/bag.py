"""A bag → a recorded log."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.columns import MotionKeys, ReadingsKeys, TableKeys
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.keys.recorded.topics import TopicsKeys
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.bags.fixes import first_place
from ekfsim.files.logs.bags.opening import opened
from ekfsim.files.logs.bags.tables import Topic, read_into, table_of
from ekfsim.files.logs.bags.topics import Chosen, topics_of
from ekfsim.files.logs.named.log import read_tables
from ekfsim.files.logs.named.tables import Source
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.text import Lines
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
    tables: list[tuple[Topic, Lines]]

    @property
    def no_truth(self) -> str:
        """Which topic is not named."""
        return "no topic is named for the true poses (topics: {truth: …})"

    def on_one_plane(self, warnings: list[str]) -> "Bag":
        """The same: its fixes are in m already."""
        return self

    def motion(self) -> tuple[Source, MotionKeys]:
        """What the robot did; speeds are told at the beginning of the time that they hold for."""
        (source,) = self._of("motion")
        return source, MotionKeys()

    def readings(self) -> list[tuple[Source, ReadingsKeys]]:
        """What the sensors told."""
        return [
            (
                self._source(lines),
                ReadingsKeys(sensor=topic.instrument.called, held=topic.chosen.held),
            )
            for topic, lines in self.tables
            if topic.instrument is not None
        ]

    def landmarks(self) -> None:
        """A bag tells no places of landmarks: they are the world's."""

    def truth(self) -> Source | None:
        """The true poses, None where no topic is named for them."""
        return next(iter(self._of("truth")), None)

    def _of(self, role: str) -> list[Source]:
        return [self._source(lines) for topic, lines in self.tables if topic.chosen.role == role]

    def _source(self, lines: Lines) -> Source:
        return Source(self.path, TableKeys(), self.recording, lines)


def read_bag(asked: Asked) -> Recorded:
    """What its topics tell, by the stamps of their messages.

    Raises UsageError where there is no bag, or where a topic is not there; InputError with what is
    wrong in the numbers.
    """
    path, world, _, recording, warnings = asked
    if recording.time_unit is not None or recording.angle_unit is not None:
        right = "leave timeUnit and angleUnit out of the recording"
        raise UsageError(f"{path}: a bag tells times in ns and angles in rad; {right}")
    with opened(path) as bag:
        keys = recording.topics or TopicsKeys()
        chosen = topics_of(bag.connections, keys, path, warnings)
        topics = _with_sensors(chosen, world, path, warnings)
        read_into(topics, bag)
    fixes = (first_place(one.messages) for one in topics if one.chosen.role == "fix")
    origin = next((place for place in fixes if place is not None), None)
    if recording.origin is not None:
        origin = recording.origin.latitude, recording.origin.longitude
    tables = [(topic, table_of(topic, origin, path, warnings)) for topic in topics]
    return read_tables(asked, Bag(path, recording, tables))


def _with_sensors(
    chosen: Sequence[Chosen], world: World, path: Path, warnings: list[str]
) -> list[Topic]:
    """The topics with the sensors of the world that they are of, without those that no sensor of it
    could be, which is told. Raises UsageError where such a one was named, and where several sensors
    could be it.
    """
    topics = list[Topic]()
    for one in chosen:
        if one.role not in SENSORS:
            topics.append(Topic(one, None))
            continue
        kinds = SENSORS[one.role]
        fit = [own for own in world.told_instruments if own.name in kinds]
        names = [own.called for own in fit]
        if one.sensor is not None:
            fit = [own for own in fit if one.sensor in (own.called, own.name)]
        where = f"{path}: topics.{one.role}: the world {world.name!r}"
        if len(fit) == 1:
            topics.append(Topic(one, fit[0]))
        elif fit:
            right = f"{{topic: {one.topic}, sensor: {names[0]}}}"
            several = f"has several sensors for {one.topic}: {', '.join(names)}"
            raise UsageError(f"{where} {several}; say which: topics: {{{one.role}: {right}}}")
        else:
            wrong = f"{where} has no sensor {one.sensor or ' or '.join(kinds)}"
            right = f"write sensors: [{{{kinds[0]}: {{}}}}] in it"
            if names:
                right = f"it has {', '.join(names)}"
            if one.said:
                raise UsageError(f"{wrong}; {right}")
            warnings.append(f"{wrong}: {one.topic} is not read; {right}")
    return topics
