"""Which topic of a bag tells what."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ekfsim.errors import UsageError
from ekfsim.files.keys.topics import TopicsKeys
from ekfsim.files.logs.tables.declared import Format
from ekfsim.files.yaml.telling import nearest, quoted

ODOMETRY = "nav_msgs/msg/Odometry"
FIX, SCAN = "sensor_msgs/msg/NavSatFix", "sensor_msgs/msg/LaserScan"
POSES = (
    ODOMETRY,
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/TransformStamped",
)
TYPES = {  # of the messages that can tell it; of landmarks any with a list of poses
    "motion": (ODOMETRY, "geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist"),
    "fix": (FIX,),
    "scan": (SCAN,),
    "truth": POSES,
}
_READ = "; ".join(f"`{role}` from {', '.join(types)}" for role, types in TYPES.items())
BAGS = Format(
    "bag",
    "A ROS 1 bag, a bag of ROS 2 or an MCAP file, read by the package rosbags (`pip install "
    f"'ekfsim[bags]'`). `topics:` of the recording says which topic tells what: {_READ}.",
    (),
    alone=True,
)
FOUND = {"motion": ODOMETRY, "fix": FIX, "scan": SCAN}  # by their type, where no topic is named


def topics_of(
    connections: Iterable[Any], asked: TopicsKeys, path: Path, warnings: list[str]
) -> dict[str, str]:
    """The topic for each role that a bag has one for: those that are named, else the only one of
    its type.

    Raises UsageError where a named topic is not there or tells another thing, where several could
    tell it, or where nothing tells the motion.
    """
    types = {connection.topic: connection.msgtype for connection in connections}
    chosen = dict[str, str]()
    for role, topic in asked.model_dump(exclude_none=True).items():
        if topic not in types:
            near = nearest(topic, list(types))
            right = f"did you mean {quoted(near)}?" if near else _listed(types)
            raise UsageError(f"{path}: topics.{role}: there is no topic {quoted(topic)}; {right}")
        if role in TYPES and types[topic] not in TYPES[role]:
            wrong = f"{quoted(topic)} is of the type {types[topic]}"
            right = f"it is read from {' or '.join(TYPES[role])}"
            raise UsageError(f"{path}: topics.{role}: {wrong}; {right}")
        chosen[role] = topic
    free = {topic: type for topic, type in types.items() if topic not in chosen.values()}
    for role, type in FOUND.items():
        if role not in chosen:
            found = [topic for topic in free if free[topic] == type]
            if len(found) == 1:
                chosen[role] = found[0]
            elif found:
                _several(path, role, found, warnings)
    if "motion" not in chosen:
        wrong = f"no topic of the type {ODOMETRY} tells the motion"
        raise UsageError(f"{path}: {wrong}; write topics: {{motion: …}}; {_listed(types)}")
    taken = ", ".join(f"{role}: {topic}" for role, topic in chosen.items())
    if set(chosen) - set(asked.model_dump(exclude_none=True)):
        warnings.append(f"{path}: read as topics: {{{taken}}}; say otherwise in the recording")
    return chosen


def _several(path: Path, role: str, found: Sequence[str], warnings: list[str]) -> None:
    wrong = f"several topics could tell it: {', '.join(found)}"
    right = f"name one: topics: {{{role}: {found[0]}}}"
    if role == "motion":
        raise UsageError(f"{path}: topics.{role}: {wrong}; {right}")
    warnings.append(f"{path}: topics.{role}: {wrong}: none is read; {right}")


def _listed(types: dict[str, str]) -> str:
    return "it has " + ", ".join(f"{topic} ({type})" for topic, type in sorted(types.items()))
