"""Messages → tables with named columns, as text: they are read on as those of any log."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from ekfsim.files.logs.bags.fixes import Place, fixes_of
from ekfsim.files.logs.bags.marks import marks_in
from ekfsim.files.logs.bags.messages import is_stamped, pose_of, seconds, stamp_of
from ekfsim.files.logs.bags.odometry import poses_of, speeds_of, tells_speeds
from ekfsim.files.logs.bags.opening import Opened
from ekfsim.files.logs.bags.scans import beams_in
from ekfsim.files.logs.bags.topics import Chosen
from ekfsim.files.logs.text import Lines
from ekfsim.systems.instrument import Instrument
from ekfsim.systems.instruments import Ultrasonic

Row = TypeVar("Row", bound=tuple[float, ...])

POSES, SPEEDS = "t,x,y,theta", "t,v,omega"
FIXES, BEAMS, MARKS = "t,x,y,sigma_x,sigma_y", "t,bearing,range", "t,target,range,bearing"


@dataclass
class Topic:
    """The messages of a topic, and the sensor that they are of."""

    chosen: Chosen
    instrument: Instrument | None
    messages: list[tuple[int, Any]] = field(default_factory=list)  # ns, and what it says
    unstamped: int = 0

    def add(self, message: Any, received: int) -> None:
        """Take one more message."""
        self.messages.append((stamp_of(message, received), message))
        self.unstamped += not is_stamped(message)


def read_into(topics: Sequence[Topic], bag: Opened) -> None:
    """Give some topics their messages. Raises UsageError where the bag is broken."""
    for name, received, message in bag.messages({one.chosen.topic for one in topics}):
        for topic in topics:
            if topic.chosen.topic == name:
                topic.add(message, received)


def table_of(topic: Topic, origin: Place | None, path: Path, warnings: list[str]) -> Lines:
    """What the messages of a topic tell, as a table."""
    role, messages = topic.chosen.role, topic.messages
    shown = f"{path} {topic.chosen.topic}"
    if topic.unstamped:
        told = f"{topic.unstamped} of {len(messages)} messages have no stamp"
        warnings.append(f"{shown}: {told}: taken is when the bag received them")
    match role:
        case "fix":
            fixes = fixes_of(messages, origin)
            warnings += [f"{shown}: {one}" for one in fixes.told]
            return _table(shown, FIXES, fixes.rows)
        case "scan":
            assert isinstance(topic.instrument, Ultrasonic)
            beams = beams_in(messages, topic.instrument)
            warnings += [f"{shown}: {one}" for one in beams.told]
            return _table(shown, BEAMS, beams.rows)
        case "landmarks":
            marks = marks_in(messages)
            warnings += [f"{shown}: {one}" for one in marks.told]
            return _table(shown, MARKS, marks.rows)
        case "motion" if tells_speeds(messages):
            speeds, told = speeds_of(messages)
            warnings += [f"{shown}: {told}"] if told else []
            return _table(shown, SPEEDS, _once(speeds, shown, warnings))
        case "motion":
            poses = poses_of(messages)
            warnings += [f"{shown}: {one}" for one in poses.told]
            return _table(shown, POSES, _once(poses.rows, shown, warnings))
    return _table(shown, POSES, ((t, *pose_of(message)) for t, message in messages))


def _once(rows: Sequence[Row], name: str, warnings: list[str]) -> list[Row]:
    """Rows without those that repeat another of the same time: a message that came twice."""
    kept = list(dict.fromkeys(rows))
    if more := len(rows) - len(kept):
        warnings.append(f"{name}: {more} of {len(rows)} messages came twice: counted once")
    return kept


def _table(name: str, head: str, rows: Iterable[Sequence[Any]]) -> Lines:
    """Rows as the lines of a text, whose first names the columns; the first entry is in ns."""
    texts = [head]
    for t, *numbers in rows:
        texts.append(",".join([seconds(t), *map(_written, numbers)]))
    return Lines(name, list(range(len(texts))), texts, True)


def _written(number: float | str) -> str:
    """A number with all its digits; nothing where there is none."""
    if isinstance(number, str):
        return number
    return "" if math.isinf(number) else repr(float(number))
