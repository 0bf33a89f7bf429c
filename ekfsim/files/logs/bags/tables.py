"""Messages → tables with named columns, as text: they are read on as those of any log."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ekfsim.files.keys.topics import OriginKeys
from ekfsim.files.logs.bags.fixes import fixes_of
from ekfsim.files.logs.bags.marks import marks_of
from ekfsim.files.logs.bags.messages import is_stamped, pose_of, seconds, stamp_of
from ekfsim.files.logs.bags.scans import beams_of
from ekfsim.files.logs.text import Lines

POSES, SPEEDS = "t,x,y,theta", "t,v,omega"
FIXES, BEAMS, MARKS = "t,x,y,sigma_x,sigma_y", "t,target,range", "t,target,range,bearing"


@dataclass
class Topic:
    """The messages of a topic."""

    role: str
    name: str
    messages: list[tuple[int, Any]] = field(default_factory=list)  # ns, and what it says
    unstamped: int = 0

    def add(self, message: Any, received: int) -> None:
        """Take one more message."""
        self.messages.append((stamp_of(message, received), message))
        self.unstamped += not is_stamped(message)


def topics_read(reader: Any, chosen: dict[str, str]) -> dict[str, Topic]:
    """The messages of the chosen topics, by their roles."""
    roles = {topic: role for role, topic in chosen.items()}
    found = {role: Topic(role, topic) for role, topic in chosen.items()}
    connections = [one for one in reader.connections if one.topic in roles]
    for connection, received, raw in reader.messages(connections=connections):
        message = reader.deserialize(raw, connection.msgtype)
        found[roles[connection.topic]].add(message, received)
    return found


def tables_of(
    topics: dict[str, Topic],
    bearings: Sequence[float],
    origin: OriginKeys | None,
    path: Path,
    warnings: list[str],
) -> dict[str, Lines]:
    """A table for each role. bearings : rad, of the beams to which scans are thinned"""
    tables = dict[str, Lines]()
    for role, topic in topics.items():
        shown = f"{path} {topic.name}"
        if topic.unstamped:
            told = f"{topic.unstamped} of {len(topic.messages)} messages have no stamp"
            warnings.append(f"{shown}: {told}: taken is when the bag received them")
        if role == "fix":
            fixes = fixes_of(topic.messages, origin)
            warnings += [f"{shown}: {one}" for one in fixes.told]
            rows = ((t, x, y, *each) for t, x, y, *each in fixes.rows)
            tables[role] = table(shown, FIXES, rows)
        elif role == "scan":
            tables[role] = table(shown, BEAMS, _beams(topic, bearings))
        elif role == "landmarks":
            seen = ((t, *mark) for t, message in topic.messages for mark in marks_of(message))
            tables[role] = table(shown, MARKS, seen)
        elif role == "motion" and _speeds_alone(topic):
            tables[role] = table(shown, SPEEDS, (_speeds(*one) for one in topic.messages))
        else:
            poses = ((t, *pose_of(message)) for t, message in topic.messages)
            tables[role] = table(shown, POSES, poses)
    return tables


def table(name: str, head: str, rows: Iterable[Sequence[Any]]) -> Lines:
    """Rows as the lines of a text, whose first names the columns; the first entry is in ns."""
    texts = [head]
    for t, *numbers in rows:
        texts.append(",".join([seconds(t), *map(_written, numbers)]))
    return Lines(name, list(range(len(texts))), texts, True)


def _written(number: float | str) -> str:
    return number if isinstance(number, str) else repr(float(number))


def _beams(topic: Topic, bearings: Sequence[float]) -> Iterable[tuple[int, str, str]]:
    """Time, number and range of each beam; no range without an echo."""
    for t, scan in topic.messages:
        for number, r in beams_of(scan, bearings):
            yield t, str(number), "" if math.isinf(r) else repr(r)


def _speeds_alone(topic: Topic) -> bool:
    """Whether an odometry tells speeds, and no pose."""
    return all(
        not hasattr(message, "pose") or pose_of(message)[:2] == (0, 0)
        for _, message in topic.messages
    )


def _speeds(t: int, message: Any) -> tuple[int, float, float]:
    """Speed ahead and turn rate."""
    twist = getattr(message, "twist", message)
    twist = getattr(twist, "twist", twist)  # of one with a covariance
    return t, twist.linear.x, twist.angular.z
