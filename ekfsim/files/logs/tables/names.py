"""What the first line of other people's files calls a column."""

import re
from typing import NamedTuple

# names that leave no doubt, in small letters with _ for what stands between words
OTHERS = {
    "t": (
        "times", "timestamp", "stamp", "time_stamp", "header_stamp", "secs", "seconds", "sec",
        "epoch", "unix", "unix_time", "utc",
    ),
    "x": ("easting", "east", "pos_x", "x_pos", "position_x", "px", "east_m", "pose_x"),
    "y": ("northing", "north", "pos_y", "y_pos", "position_y", "py", "north_m", "pose_y"),
    "heading": ("yaw", "orientation", "psi", "th", "theta_z", "pose_theta", "azimuth"),
    "yaw": ("heading", "theta", "psi", "orientation"),
    "vl": ("left", "v_left", "vleft", "left_speed", "speed_left", "left_velocity", "v_l"),
    "vr": ("right", "v_right", "vright", "right_speed", "speed_right", "right_velocity", "v_r"),
    "left": ("dl", "d_left", "left_distance", "distance_left", "delta_left"),
    "right": ("dr", "d_right", "right_distance", "distance_right", "delta_right"),
    "speed": ("v", "velocity", "forward_velocity", "linear", "linear_velocity", "linear_x", "vx"),
    "turn rate": (
        "omega", "w", "angular", "angular_velocity", "angular_z", "yaw_rate", "yawrate", "wz",
        "turn_rate",
    ),
    "distance": ("d", "dist", "ds", "delta_distance", "delta_d"),
    "dheading": (
        "turn", "dtheta", "dth", "delta_heading", "delta_theta", "dyaw", "delta_yaw", "angle",
    ),
    "range": ("r", "dist", "distance", "meas_range"),
    "bearing": ("phi", "angle", "b", "azimuth", "theta"),
    "node": ("anchor", "beacon", "id", "node_id", "anchor_id", "landmark", "target"),
    "subject": ("subject_#", "id", "landmark", "landmark_id", "subject_id"),
    "barcode": ("barcode_#", "subject_#", "code", "id", "landmark", "landmark_id"),
    "orientation": ("heading", "theta", "yaw", "phi", "psi"),
}  # fmt: skip
UNITS = {
    "s": "s", "sec": "s", "secs": "s", "seconds": "s", "ms": "ms", "msec": "ms",
    "milliseconds": "ms", "us": "us", "µs": "us", "usec": "us", "microseconds": "us", "ns": "ns",
    "nsec": "ns", "nsecs": "ns", "nanoseconds": "ns", "m": "m", "cm": "cm", "mm": "mm", "km": "km",
    "metres": "m", "meters": "m", "rad": "rad", "radians": "rad", "deg": "degrees",
    "degrees": "degrees", "degree": "degrees", "°": "degrees", "m/s": "m/s", "rad/s": "rad/s",
    "deg/s": "degrees/s", "°/s": "degrees/s", "degrees/s": "degrees/s",
}  # fmt: skip
IN_BRACKETS = re.compile(r"(.*?)[\s_]*[\[(]\s*([^\])]*?)\s*[\])]")
AFTER_BAR = re.compile(r"(.+)_([a-zµ]+)")


class Named(NamedTuple):
    """What a first line says of a column."""

    whole: str  # as it stands there, in small letters
    name: str  # without its unit, _ between words
    unit: str | None  # that stands beside the name


def named(text: str) -> Named:
    """A name of a first line, and the unit that it tells.

    >>> named("Time_ns"), named("Bearing [deg]")
    (Named(whole='time_ns', name='time', unit='ns'), Named(whole='bearing [deg]', \
name='bearing', unit='degrees'))
    """
    whole = text.strip().strip("\"'").strip().lower()
    for pattern in IN_BRACKETS, AFTER_BAR:
        found = pattern.fullmatch(whole)
        if found and found[1] and found[2] in UNITS:
            return Named(whole, _joined(found[1]), UNITS[found[2]])
    return Named(whole, _joined(whole), None)


def _joined(name: str) -> str:
    return re.sub(r"[\s_.\-/]+", "_", name.strip()).strip("_")
