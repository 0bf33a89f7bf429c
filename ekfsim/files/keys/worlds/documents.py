"""What the documents' systems have, which the descriptions of keys tell as defaults."""

import dataclasses
import math
from typing import Any, get_args, get_type_hints

from ekfsim.models.layout import POSE
from ekfsim.systems import SYSTEMS
from ekfsim.systems.instruments import Infrared, Pylon, Ultrasonic
from ekfsim.systems.robots import PylonCart


def degrees(angles: Any) -> Any:
    """Radians as a file writes them, also those in tuples of tuples."""
    return [degrees(one) for one in angles] if isinstance(angles, tuple) else math.degrees(angles)


def of_robots(name: str, what: str, is_angle: bool = False) -> str:
    """The description of a robot's key, with the document's number for each system that has it."""
    numbers = {
        system: getattr(told.robot, name) for system,
        told in SYSTEMS.items() if name in robot_fields(system)
    }  # fmt: skip
    shown = {
        system: f"{degrees(number) if is_angle else number:.6g}"
        for system, number in numbers.items()
    }
    return f"{what} Default: {', '.join(f'{system} {number}' for system, number in shown.items())}."


def robot_fields(system: str) -> list[str]:
    """The names of what a file may tell of the robot of a system, in their order."""
    return [*fields_of(type(SYSTEMS[system].robot)), "estimate"]


def not_carried(system: str) -> tuple[str, ...]:
    """The kinds of sensors that the robot of a system cannot carry.

    The pylon's offset is turned by the yaw that its cart measures, and beams meet walls from a
    state that is a pose.
    """
    robot = SYSTEMS[system].robot
    turned = () if isinstance(robot, PylonCart) else (Pylon.name,)
    return turned if robot.layout == POSE else (*turned, Ultrasonic.name, Infrared.name)


def fields_of(part: Any) -> list[str]:
    """The names of what a robot, an instrument or a drive is made from, in their order."""
    return [field.name for field in dataclasses.fields(part) if field.init]


ODOMETRY = {  # what may tell the turn of each robot
    system: get_args(get_type_hints(type(told.robot))["odometry"])
    for system, told in SYSTEMS.items()
    if "odometry" in robot_fields(system)
}
