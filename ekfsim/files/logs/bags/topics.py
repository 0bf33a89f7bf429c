"""Which topic of a bag tells what."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.topics import SensorTopicKeys, TopicsKeys
from ekfsim.files.yaml.telling import nearest, quoted

ODOMETRY = "nav_msgs/msg/Odometry"
FIX, SCAN = "sensor_msgs/msg/NavSatFix", "sensor_msgs/msg/LaserScan"
POSES = (
    ODOMETRY,
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/TransformStamped",
    "geometry_msgs/msg/Pose2D",
)
SPEEDS = (
    "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/TwistWithCovarianceStamped",
    "geometry_msgs/msg/Twist",
)
TYPES = {  # of the messages that can tell it; of landmarks any with a list of poses
    "motion": (*POSES, *SPEEDS),
    "fix": (FIX,),
    "scan": (SCAN,),
    "truth": POSES,
}
FOUND = {"motion": ODOMETRY, "fix": FIX, "scan": SCAN}  # by their type, where no topic is named


class Chosen(NamedTuple):
    """A topic that is read."""

    role: str
    topic: str
    sensor: str | None = None  # of the world, where it is said
    held: bool | None = None  # whether a reading that repeats the one before is no new one
    said: bool = True  # whether the recording names it


def topics_of(
    connections: Iterable[Any], asked: TopicsKeys, path: Path, warnings: list[str]
) -> list[Chosen]:
    """The topics that a bag has for each role: those that are named, else the only one of its type.

    connections : of the bag, each with topic, msgtype and msgcount
    Raises UsageError where a named topic is not there or tells another thing, where several could
    tell it, or where nothing tells the motion.
    """
    connections = list(connections)
    all_types = {one.topic: one.msgtype for one in connections}
    # topics without a message do not count: recorders write down all that was offered
    types = {one.topic: one.msgtype for one in connections if one.msgcount}
    chosen = _named(asked)
    for one in chosen:
        if one.topic not in types:
            raise UsageError(
                f"{path}: topics.{one.role}: {_not_there(one.topic, types, all_types)}"
            )
        if one.role in TYPES and types[one.topic] not in TYPES[one.role]:
            wrong = f"{quoted(one.topic)} is of the type {types[one.topic]}"
            right = f"it is read from {' or '.join(TYPES[one.role])}"
            raise UsageError(f"{path}: topics.{one.role}: {wrong}; {right}")
    said = {one.role for one in chosen}
    taken = {one.topic for one in chosen}
    for role, type in FOUND.items():
        fit = [topic for topic, own in types.items() if own == type and topic not in taken]
        if role in said or not fit:
            continue
        if len(fit) == 1:
            chosen.append(Chosen(role, fit[0], said=False))
        else:
            _several(path, role, fit, warnings)
    if not any(one.role == "motion" for one in chosen):
        raise UsageError(f"{path}: {_no_motion(types)}")
    if not all(one.said for one in chosen):
        read = ", ".join(f"{one.role}: {one.topic}" for one in chosen)
        warnings.append(f"{path}: read as topics: {{{read}}}; say otherwise in the recording")
    return chosen


def _named(asked: TopicsKeys) -> list[Chosen]:
    """The topics that the recording names."""
    chosen = list[Chosen]()
    for role in TopicsKeys.model_fields:
        told: str | SensorTopicKeys | list[SensorTopicKeys] | None = getattr(asked, role)
        for one in told if isinstance(told, list) else [told] if told is not None else []:
            if isinstance(one, str):
                chosen.append(Chosen(role, one))
            else:
                chosen.append(Chosen(role, one.topic, one.sensor, one.held))
    return chosen


def _not_there(topic: str, types: dict[str, str], all_types: dict[str, str]) -> str:
    """What is wrong with a topic that holds nothing."""
    if topic in all_types:
        return f"{quoted(topic)} holds no message; {_listed(types)}"
    near = nearest(topic, list(types))
    return f"there is no topic {quoted(topic)}; " + (
        f"did you mean {quoted(near)}?" if near else _listed(types)
    )


def _several(path: Path, role: str, found: Sequence[str], warnings: list[str]) -> None:
    wrong = f"several topics could tell it: {', '.join(found)}"
    right = f"name one: topics: {{{role}: {found[0]}}}"
    if role == "motion":
        raise UsageError(f"{path}: topics.{role}: {wrong}; {right}")
    warnings.append(f"{path}: topics.{role}: {wrong}: none is read; {right}")


def _no_motion(types: dict[str, str]) -> str:
    """What is wrong with a bag in which nothing surely tells the motion."""
    wrong = f"no topic of the type {ODOMETRY} tells the motion"
    fit = [topic for topic, type in types.items() if type in TYPES["motion"]]
    if fit:
        return f"{wrong}; name one that does: topics: {{motion: {fit[0]}}}; {_listed(types)}"
    return f"{wrong}, nor one of {' or '.join(TYPES['motion'][1:])}; {_listed(types)}"


def _listed(types: dict[str, str]) -> str:
    if not types:
        return "it has no messages at all"
    return "it has " + ", ".join(f"{topic} ({type})" for topic, type in sorted(types.items()))
