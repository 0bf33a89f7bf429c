"""The keys of a world file that tell of a document's system and of its robot."""

import dataclasses
import math
from collections.abc import Iterable
from typing import Annotated, Any, ClassVar, Literal, get_args, get_type_hints

from pydantic import BaseModel, Field
from pydantic.config import JsonDict

from ekfsim.files.keys.faults import FaultKeys
from ekfsim.files.keys.fields import (
    PartKeys,
    Positive,
    Rate,
    Ratio,
    Scale,
    Spread,
    Turn,
    aliases,
)
from ekfsim.models.layout import POSE
from ekfsim.systems import SYSTEMS
from ekfsim.systems.instruments import Infrared, Pylon, Ultrasonic
from ekfsim.systems.robots import PylonCart
from ekfsim.world import Faults

Row = Annotated[
    list[Scale],
    Field(title="a pair [right, left]", min_length=2, max_length=2, examples=[[0.5, 0.5]]),
]


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


class ScaleErrorKeys(PartKeys):
    """A factor of what is measured, which the filter finds: its error is 0 where it is right."""

    sigma: Spread = Field(description="Standard deviation at the start, as a share of it.")
    drift: Spread = Field(
        0.0, description="How it wanders: by so much per √s. 0: not at all.", examples=[0.001]
    )


class TurnErrorKeys(PartKeys):
    """What is added to a turn rate, or to the yaw, which the filter finds."""

    angles: ClassVar[frozenset[str]] = frozenset({"sigma", "drift"})

    sigma: Turn = Field(
        description="Standard deviation at the start, degrees per second; of the yaw degrees."
    )
    drift: Turn = Field(
        0.0, description="How it wanders: by so much per √s. 0: not at all.", examples=[0.001]
    )


class AccelerationErrorKeys(PartKeys):
    """What is added to an acceleration, which the filter finds."""

    sigma: Spread = Field(description="Standard deviation at the start, m/s².")
    drift: Spread = Field(
        0.0, description="How it wanders: by so much per √s. 0: not at all.", examples=[0.001]
    )


class EstimateKeys(PartKeys):
    """What the robot measures wrongly all the while, and its filter finds out: each makes the state
    one entry longer. Of a scale it is the error: 0.02 where 2 % too much is measured.
    """

    gyro_bias: TurnErrorKeys | None = Field(
        None,
        alias="gyroBias",
        description="Added to the turn rate: mower, landmarks, ranges.",
        examples=[{"sigma": 0.5}],
    )
    wheel_scale: ScaleErrorKeys | None = Field(
        None,
        alias="wheelScale",
        description="Of all of the way or speed: mower, pioneer, gnss, landmarks, ranges.",
        examples=[{"sigma": 0.05}],
    )
    left_scale: ScaleErrorKeys | None = Field(
        None,
        alias="leftScale",
        description="Of the left wheel: mower, pioneer, gnss.",
        examples=[{"sigma": 0.05}],
    )
    right_scale: ScaleErrorKeys | None = Field(
        None,
        alias="rightScale",
        description="Of the right wheel: mower, pioneer, gnss.",
        examples=[{"sigma": 0.05}],
    )
    turn_scale: ScaleErrorKeys | None = Field(
        None,
        alias="turnScale",
        description="Of the turn or turn rate: landmarks, ranges.",
        examples=[{"sigma": 0.05}],
    )
    forward_bias: AccelerationErrorKeys | None = Field(
        None,
        alias="forwardBias",
        description="Added to the forward acceleration: pylon.",
        examples=[{"sigma": 0.1}],
    )
    lateral_bias: AccelerationErrorKeys | None = Field(
        None,
        alias="lateralBias",
        description="Added to the sideward acceleration: pylon.",
        examples=[{"sigma": 0.1}],
    )
    yaw_bias: TurnErrorKeys | None = Field(
        None,
        alias="yawBias",
        description="Added to the yaw: pylon.",
        examples=[{"sigma": 2}],
    )


class ToldRobotKeys(PartKeys):
    """What the robot measures of its motion, and how well.
    Each system's robot has some of these keys.
    """

    angles: ClassVar[frozenset[str]] = frozenset(
        {"heading_sigma", "gyro_sigma", "turn_density", "yaw_sigma", "heading_density"}
    )

    width: Positive | None = Field(
        None,
        description=of_robots("width", "Between the left and the right wheel, m."),
        examples=[1.41],
    )
    wheel_sigma: Spread | None = Field(
        None,
        alias="wheelSigma",
        description=of_robots(
            "wheel_sigma", "Standard deviation of the way of each wheel in one input, m."
        ),
    )
    position_sigma: Spread | None = Field(
        None,
        alias="positionSigma",
        description=of_robots(
            "position_sigma", "Process noise of x and y in one input, standard deviation in m."
        ),
    )
    heading_sigma: Turn | None = Field(
        None,
        alias="headingSigma",
        description=of_robots(
            "heading_sigma", "Process noise of the heading in one input, degrees.", True
        ),
    )
    gyro_sigma: Turn | None = Field(
        None,
        alias="gyroSigma",
        description=of_robots(
            "gyro_sigma", "Standard deviation of the gyro's turn rate, degrees per second.", True
        ),
    )
    wheel_ratio: Ratio | None = Field(
        None,
        alias="wheelRatio",
        description=of_robots("wheel_ratio", "Noise of the way of a wheel, per metre."),
    )
    wheel_floor: Spread | None = Field(
        None,
        alias="wheelFloor",
        description=of_robots(
            "wheel_floor", "Noise of the way of a wheel that stands still, standard deviation in m."
        ),
        examples=[0.002],
    )
    odometry: Literal["arctan", "midpoint", "skidSteer", "gyro"] | None = Field(
        None,
        description="What tells the turn. mower: its gyro (the default), or the wheels by "
        "equation 20 (midpoint). pioneer: the wheels by equation 33 with its arctangent (the "
        "default), by the mid-point rule, or by the skid-steer matrix of equation 30.",
        examples=["midpoint"],
    )
    skid: list[Row] | None = Field(
        None,
        title="a list of three pairs",
        min_length=3,
        max_length=3,
        description="The skid-steer matrix of equation 30: forward speed, sideward speed (m/s) "
        "and turn rate (rad/s) of the speeds [right, left] (m/s). Default: pioneer [[0.5, 0.5], "
        "[0, 0], [2.5, -2.5]].",
        examples=[[[0.5, 0.5], [0, 0], [2.5, -2.5]]],
    )
    skid_sigma: Spread | None = Field(
        None,
        alias="skidSigma",
        description=of_robots("skid_sigma", "Standard deviation of the speed of each side, m/s."),
    )
    half_track: Positive | None = Field(
        None,
        alias="halfTrack",
        description=of_robots("half_track", "Half of the way between two wheels, m."),
    )
    speed_density: Spread | None = Field(
        None,
        alias="speedDensity",
        description=of_robots("speed_density", "Noise of the speed, m/s per √Hz."),
    )
    turn_density: Turn | None = Field(
        None,
        alias="turnDensity",
        description=of_robots(
            "turn_density", "Noise of the turn rate, degrees per second per √Hz.", True
        ),
    )
    start_speed_sigma: Spread | None = Field(
        None,
        alias="startSpeedSigma",
        description=of_robots(
            "start_speed_sigma", "Standard deviation of the speed in the first belief, m/s."
        ),
    )
    forward_sigma: Spread | None = Field(
        None,
        alias="forwardSigma",
        description=of_robots(
            "forward_sigma", "Standard deviation of the forward acceleration, m/s²."
        ),
    )
    lateral_sigma: Spread | None = Field(
        None,
        alias="lateralSigma",
        description=of_robots(
            "lateral_sigma", "Standard deviation of the sideward acceleration, m/s²."
        ),
    )
    yaw_sigma: Turn | None = Field(
        None,
        alias="yawSigma",
        description=of_robots("yaw_sigma", "Standard deviation of the yaw, degrees.", True),
    )
    distance_density: Spread | None = Field(
        None,
        alias="distanceDensity",
        description=of_robots("distance_density", "Noise of the way, m per √s."),
    )
    heading_density: Turn | None = Field(
        None,
        alias="headingDensity",
        description=of_robots("heading_density", "Noise of the heading, degrees per √s.", True),
    )

    estimate: EstimateKeys | None = Field(
        None,
        description="What the filter is to find out of the robot beside its pose. It is the "
        "filter's alone: in the truth it changes nothing.",
        examples=[{"gyroBias": {"sigma": 0.5}}],
    )


class RobotKeys(ToldRobotKeys):
    """What the robot measures of its motion, and how well.
    Each system's robot has some of these keys.
    """

    rate: Rate | None = Field(
        None, description=of_robots("rate", "Motion inputs per second, Hz."), examples=[100]
    )


def only(names: Iterable[str], keys: type[BaseModel]) -> JsonDict:
    """A mapping with no other of a model's keys than these."""
    known = aliases(keys)
    return {"propertyNames": {"enum": [known[name] for name in names]}}


def of_system(system: str) -> JsonDict:
    """What a world of a driven robot may hold."""
    robot = robot_fields(system)
    turning: JsonDict = (
        {"properties": {"odometry": {"enum": list(ODOMETRY[system])}}} if system in ODOMETRY else {}
    )
    believed = only((name for name in robot if name != "rate"), ToldRobotKeys)
    told: JsonDict = {"noise": False, "robot": {**believed, **turning}}
    return {
        "noise": False,
        "robot": {**only(robot, RobotKeys), **turning},
        "faults": only((*SYSTEMS[system].robot.faults, "sensors"), FaultKeys),
        "belief": {"properties": told},
        "sensors": {"items": {"properties": dict.fromkeys(not_carried(system), False)}},
    }


IN_THE_CLASSROOM: JsonDict = {
    "robot": False,
    "sensors": False,
    "faults": only((field.name for field in dataclasses.fields(Faults)), FaultKeys),
    "belief": {"properties": {"robot": False, "sensors": False}},
}
CLASSROOM: JsonDict = {
    "if": {"properties": {"system": {"const": "classroom"}}},
    "then": {"required": ["noise"], "properties": IN_THE_CLASSROOM},
}


def where_it_is(system: str) -> JsonDict:
    """The condition of a system."""
    told: JsonDict = {"properties": {"system": {"const": system}}, "required": ["system"]}
    return {"if": told, "then": {"properties": of_system(system)}}


# what a world of each system may hold
BY_SYSTEM: JsonDict = {"allOf": [CLASSROOM, *map(where_it_is, SYSTEMS)]}
