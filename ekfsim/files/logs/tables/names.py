"""What the first line of other people's files calls a column."""

import re
from typing import NamedTuple

# what stands before the name of a field in a table of ROS messages
OF_A_POSE = ("pose_pose_", "field_pose_", "field_pose_pose_")
OF_A_TWIST = ("twist_", "twist_twist_", "field_", "field_twist_", "field_twist_twist_")
# names that leave no doubt, in small letters with _ for what stands between words
OTHERS = {
    "t": (
        "times", "timestamp", "stamp", "time_stamp", "header_stamp", "secs", "seconds", "sec",
        "epoch", "unix", "unix_time", "utc",
    ),
    "x": ("easting", "east", "pos_x", "x_pos", "position_x", "px", "east_m", "pose_x",
        *(f"{of}position_x" for of in OF_A_POSE),
    ),
    "y": ("northing", "north", "pos_y", "y_pos", "position_y", "py", "north_m", "pose_y",
        *(f"{of}position_y" for of in OF_A_POSE),
    ),
    "heading": ("yaw", "orientation", "psi", "th", "theta_z", "pose_theta", "azimuth"),
    "yaw": ("heading", "theta", "psi", "orientation"),
    "vl": ("left", "v_left", "vleft", "left_speed", "speed_left", "left_velocity", "v_l"),
    "vr": ("right", "v_right", "vright", "right_speed", "speed_right", "right_velocity", "v_r"),
    "left": ("dl", "d_left", "left_distance", "distance_left", "delta_left"),
    "right": ("dr", "d_right", "right_distance", "distance_right", "delta_right"),
    "speed": ("v", "velocity", "forward_velocity", "linear", "linear_velocity", "linear_x", "vx",
        *(f"{of}linear_x" for of in OF_A_TWIST),
    ),
    "turn rate": (
        "omega", "w", "angular", "angular_velocity", "angular_z", "yaw_rate", "yawrate", "wz",
        "turn_rate", *(f"{of}angular_z" for of in OF_A_TWIST),
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
# how a first line writes a unit, in small letters, and what that is among keys.columns.UNITS
SPELLED = {
    "s": "s", "sec": "s", "secs": "s", "seconds": "s", "ms": "ms", "msec": "ms",
    "milliseconds": "ms", "us": "us", "µs": "us", "usec": "us", "microseconds": "us", "ns": "ns",
    "nsec": "ns", "nsecs": "ns", "nanoseconds": "ns", "m": "m", "cm": "cm", "mm": "mm", "km": "km",
    "metres": "m", "meters": "m", "m/s": "m/s", "cm/s": "cm/s", "mm/s": "mm/s", "km/h": "km/h",
    "rad": "rad", "radians": "rad", "deg": "degrees", "degrees": "degrees", "degree": "degrees",
    "°": "degrees", "rad/s": "rad/s", "deg/s": "degrees/s", "°/s": "degrees/s",
    "degrees/s": "degrees/s", "m/s²": "m/s²", "m/s^2": "m/s²",
}  # fmt: skip
TIMES = ("s", "ms", "us", "ns")
IN_BRACKETS = re.compile(r"(.*?)[\s_]*[\[(]\s*([^\])]*?)\s*[\])]")
AFTER_BAR = re.compile(r"(.+)_([^_\s]+)")


class Named(NamedTuple):
    """What a first line says of a column."""

    whole: str  # as it stands there, in small letters
    name: str  # without its unit, _ between words
    unit: str | None  # that stands beside the name


def named(text: str) -> Named:
    """A name of a first line, and the unit that it tells.

    >>> [one[1:] for one in map(named, ("Time_ns", "Bearing [deg]", "v_ms", "sigma_x"))]
    [('time', 'ns'), ('bearing', 'degrees'), ('v', 'm/s'), ('sigma_x', None)]
    """
    whole = text.strip().strip("\"'").strip().lower()
    for pattern in IN_BRACKETS, AFTER_BAR:
        found = pattern.fullmatch(whole)
        if found and found[1] and found[2] in SPELLED:
            name, unit = _joined(found[1]), SPELLED[found[2]]
            if unit not in TIMES or _is_time(name):
                return Named(whole, name, unit)
            if unit == "ms":  # m/s, as it is written where no stroke can be
                return Named(whole, name, "m/s")
    found = IN_BRACKETS.fullmatch(whole)
    if found and found[1] and found[2] == "g":  # behind a bar it is no unit: x_g, the x of a goal
        return Named(whole, _joined(found[1]), "g")
    return Named(whole, _joined(whole), None)


def _is_time(name: str) -> bool:
    return name in ("t", *OTHERS["t"]) or "time" in name or "stamp" in name


def _joined(name: str) -> str:
    return re.sub(r"[\s_.\-/]+", "_", name.strip()).strip("_")
