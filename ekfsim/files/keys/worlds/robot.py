"""The keys of a world file that tell of a document's system and of its robot."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ekfsim.files.keys.fields import (
    PartKeys,
    Positive,
    Rate,
    Ratio,
    Scale,
    Spread,
    Turn,
)
from ekfsim.files.keys.worlds.documents import of_robots
from ekfsim.files.keys.worlds.estimated import EstimateKeys

Row = Annotated[
    list[Scale],
    Field(title="a pair [right, left]", min_length=2, max_length=2, examples=[[0.5, 0.5]]),
]


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
