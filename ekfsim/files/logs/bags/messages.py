"""When a message was stamped, and what its quaternion says of a heading."""

import math
from typing import Any

SECOND = 10**9  # ns


def stamp_of(message: Any, received: int) -> int:
    """The instant of a message in ns: that of its header; where that is 0 or absent, when the bag
    received it.
    """
    header = getattr(message, "header", None)
    if header is None:
        return received
    stamp: int = header.stamp.sec * SECOND + header.stamp.nanosec
    return stamp or received


def is_stamped(message: Any) -> bool:
    """Whether a header says when the message is of."""
    header = getattr(message, "header", None)
    return header is not None and bool(header.stamp.sec or header.stamp.nanosec)


def seconds(ns: int) -> str:
    """An instant in s, with all its digits.

    >>> seconds(1_700_000_000_000_000_042)
    '1700000000.000000042'
    """
    return f"{ns // SECOND}.{ns % SECOND:09d}"


def yaw_of(quaternion: Any) -> float:
    """The heading of an orientation in rad, counter-clockwise from +x; nan where it is none."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    if not math.isfinite(x + y + z + w) or x == y == z == w == 0:
        return math.nan
    # by the squares of all four, for not every program writes one of norm 1
    return math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z)


def pose_of(message: Any) -> tuple[float, float, float]:
    """x, y and heading of any message with a pose."""
    held = getattr(message, "transform", None)
    if held is not None:
        return held.translation.x, held.translation.y, yaw_of(held.rotation)
    held = getattr(message, "pose", None)
    if held is None:  # of a plane alone
        return message.x, message.y, message.theta
    held = getattr(held, "pose", held)  # of one with a covariance
    return held.position.x, held.position.y, yaw_of(held.orientation)


def twist_of(message: Any) -> Any:
    """The speeds that a message tells, in its robot's own frame; None where it tells none."""
    held = getattr(message, "twist", message)
    held = getattr(held, "twist", held)  # of one with a covariance
    return held if hasattr(held, "linear") else None
