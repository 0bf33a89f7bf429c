"""Poses of landmarks that a camera sees: what each message tells of range and bearing."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from ekfsim.files.logs.bags.messages import stamp_of

LISTS = ("markers", "detections", "tags", "transforms")  # as packages of markers call them
IDS = ("id", "fiducial_id", "marker_id", "child_frame_id")
OPTICAL = "optical"  # in the name of a frame whose z looks ahead and whose x looks to the right
GLOBAL = ("map", "odom", "world", "earth")  # frames that no robot carries


class Marks(NamedTuple):
    """What some messages tell of landmarks, and what is to be told of that."""

    rows: list[tuple[int, str, float, float]]  # ns, id, range in m, bearing in rad
    told: list[str]


def marks_in(messages: Sequence[tuple[int, Any]]) -> Marks:
    """The landmarks of all messages, each at its own stamp where it has one."""
    rows, frames, far = list[tuple[int, str, float, float]](), dict[str, int](), 0
    for t, message in messages:
        for mark in held_by(message):
            frame = _frame(mark) or _frame(message)
            if frame.strip("/") in GLOBAL:
                far += 1
                continue
            seen = _seen(mark, frame)
            if seen is not None:
                frames[frame] = frames.get(frame, 0) + 1
                rows.append((stamp_of(mark, t), _id(mark, frame), *seen))
    told = [
        f"the frame {frame!r} is taken as "
        + ("z ahead, x to the right" if OPTICAL in frame else "x ahead, y to the left")
        + ", as names with 'optical' and others have it (REP 103); the sensor's mount in the world "
        "says where it sits"
        for frame in frames
    ]
    if far:
        told.append(
            f"{far} poses are in a frame of the ground ({', '.join(GLOBAL)}), not in one that the "
            "robot carries: left out"
        )
    return Marks(rows, told)


def held_by(message: Any) -> Iterator[Any]:
    """The marks of a message: of its list, of two lists of ids and poses, or itself."""
    if hasattr(message, "marker_ids") and hasattr(message, "poses"):
        for id, pose in zip(message.marker_ids, message.poses, strict=False):
            yield _Mark(id, pose)
        return
    name = next((name for name in LISTS if hasattr(message, name)), None)
    yield from [message] if name is None else getattr(message, name)


class _Mark(NamedTuple):
    """A mark of which a message tells in two lists."""

    id: Any
    pose: Any


def _seen(mark: Any, frame: str) -> tuple[float, float] | None:
    """Range in m and bearing in rad, counter-clockwise from ahead; None without a place."""
    pose = getattr(mark, "pose", None)
    while (inner := getattr(pose, "pose", None)) is not None:  # with a header, a covariance
        pose = inner
    place = getattr(pose, "position", None) or getattr(
        getattr(mark, "transform", None), "translation", None
    )
    if place is None or not math.isfinite(place.x + place.y + place.z):
        return None
    ahead, left = (place.z, -place.x) if OPTICAL in frame else (place.x, place.y)
    return math.hypot(ahead, left), math.atan2(left, ahead)


def _frame(message: Any) -> str:
    header = getattr(message, "header", None)
    return "" if header is None else str(header.frame_id)


def _id(mark: Any, frame: str) -> str:
    """How a landmark is called; of a message that holds one alone, its frame."""
    id = next((getattr(mark, name) for name in IDS if hasattr(mark, name)), None)
    if id is None:
        return frame
    if hasattr(id, "__len__") and not isinstance(id, str):  # of a bundle of tags, the first
        id = id[0] if len(id) else ""
    return str(id).replace(",", " ")
