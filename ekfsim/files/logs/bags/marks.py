"""Poses of landmarks that a camera sees: what each message tells of range and bearing."""

import math
from collections.abc import Iterator
from typing import Any

LISTS = ("markers", "detections", "tags")  # as packages of markers call them
OPTICAL = "optical"  # in the name of a frame whose z looks ahead and whose x looks to the right


def marks_of(message: Any) -> Iterator[tuple[str, float, float]]:
    """Id, range in m and bearing in rad, counter-clockwise from ahead, of each landmark.

    A frame is taken as x ahead and y to the left (REP 103), one of a camera's optics as z ahead and
    x to the right.
    """
    held = next((getattr(message, name) for name in LISTS if hasattr(message, name)), [message])
    for mark in held:
        pose = getattr(mark, "pose", None)
        while (inner := getattr(pose, "pose", None)) is not None:  # with a header, a covariance
            pose = inner
        place = getattr(pose, "position", None)
        if place is None or not math.isfinite(place.x + place.y + place.z):
            continue
        ahead, left = place.x, place.y
        if OPTICAL in _frame(mark) or OPTICAL in _frame(message):
            ahead, left = place.z, -place.x
        yield _id(mark, message), math.hypot(ahead, left), math.atan2(left, ahead)


def _frame(message: Any) -> str:
    header = getattr(message, "header", None)
    return "" if header is None else str(header.frame_id)


def _id(mark: Any, message: Any) -> str:
    """How a landmark is called; of a message that holds one alone, its frame."""
    id = getattr(mark, "id", None)
    if id is None:
        return _frame(message)
    return str(id[0] if hasattr(id, "__len__") and not isinstance(id, str) else id)
