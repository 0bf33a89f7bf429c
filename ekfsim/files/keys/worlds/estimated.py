"""The keys of what a robot measures wrongly all the while, and its filter finds out."""

from typing import ClassVar

from pydantic import Field

from ekfsim.files.keys.fields import (
    PartKeys,
    Spread,
    Turn,
)


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
