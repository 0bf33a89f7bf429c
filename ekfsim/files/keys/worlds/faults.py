"""The keys of a world file that set what is wrong with a driven robot or its sensors: `faults`."""

from typing import ClassVar

from pydantic import ConfigDict, Field

from ekfsim.files.keys.fields import (
    Degrees,
    Metres,
    PartKeys,
    Probability,
    Ratio,
    Scale,
    Spread,
    Strict,
)


class FaultyKeys(PartKeys):
    """What may be wrong with any sensor. A bias for each number that it tells comes on top."""

    outliers: Probability = Field(0.0, description="Probability that a reading is an outlier.")
    outlier_size: Ratio = Field(
        10.0,
        alias="outlierSize",
        description="By how much the noise of an outlier is larger.",
        examples=[10],
    )
    delay: Spread = Field(
        0.0,
        description="What is read was there so many seconds ago; the filter is given it as of now.",
        examples=[0.2],
    )

    def biases(self) -> tuple[float, ...]:
        """What is added to each number of a reading, angles in radians."""
        own = [name for name in type(self).model_fields if name not in FaultyKeys.model_fields]
        given = self.given()
        return tuple(given.get(name, 0.0) for name in own)


class FaultyMarkersKeys(FaultyKeys):
    """What is wrong with the cameras."""

    angles: ClassVar[frozenset[str]] = frozenset({"azimuth_bias", "elevation_bias"})

    azimuth_bias: Degrees = Field(
        0.0, alias="azimuthBias", description="Degrees added to every azimuth."
    )
    elevation_bias: Degrees = Field(
        0.0, alias="elevationBias", description="Degrees added to every elevation."
    )


class FaultyRangeBearingKeys(FaultyKeys):
    """What is wrong with a camera for range and bearing."""

    angles: ClassVar[frozenset[str]] = frozenset({"bearing_bias"})

    range_bias: Metres = Field(0.0, alias="rangeBias", description="m added to every range.")
    bearing_bias: Degrees = Field(
        0.0, alias="bearingBias", description="Degrees added to every bearing."
    )


class FaultyBearingKeys(FaultyKeys):
    """What is wrong with a camera for bearings."""

    angles: ClassVar[frozenset[str]] = frozenset({"bias"})

    bias: Degrees = Field(0.0, description="Degrees added to every bearing.")


class FaultyRangeKeys(FaultyKeys):
    """What is wrong with ranges."""

    bias: Metres = Field(0.0, description="m added to every range.")


class FaultyGnssKeys(FaultyKeys):
    """What is wrong with fixes."""

    x_bias: Metres = Field(0.0, alias="xBias", description="m added to every x.")
    y_bias: Metres = Field(0.0, alias="yBias", description="m added to every y.")


class FaultyPylonKeys(FaultyKeys):
    """What is wrong with a lidar."""

    ahead_bias: Metres = Field(
        0.0, alias="aheadBias", description="m by which all is seen too far ahead."
    )
    left_bias: Metres = Field(
        0.0, alias="leftBias", description="m by which all is seen too far to the left."
    )


class FaultyLidarKeys(FaultyKeys):
    """What is wrong with a lidar that is read in its own frame."""

    right_bias: Metres = Field(
        0.0, alias="rightBias", description="m by which all is seen too far to the right."
    )
    ahead_bias: Metres = Field(
        0.0, alias="aheadBias", description="m by which all is seen too far ahead."
    )


class FaultyInfraredKeys(FaultyKeys):
    """What is wrong with intensities."""

    bias: Metres = Field(0.0, description="V added to every intensity.")


class FaultyYawKeys(FaultyKeys):
    """What is wrong with a compass or a gyroscope."""

    angles: ClassVar[frozenset[str]] = frozenset({"bias"})

    bias: Degrees = Field(0.0, description="Degrees added to every yaw.")


class FaultyNamedKeys(
    FaultyMarkersKeys,
    FaultyRangeBearingKeys,
    FaultyGnssKeys,
    FaultyPylonKeys,
    FaultyLidarKeys,
    FaultyInfraredKeys,
):
    """What is wrong with a sensor that has a name of its own: the keys of its kind."""


class FaultySensorsKeys(Strict):
    """What is wrong with the sensors, by their names: the kind where they have no other."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, FaultyNamedKeys] = Field(init=False)

    markers: FaultyMarkersKeys | None = Field(
        None, description="Cameras.", examples=[{"azimuthBias": 1}]
    )
    range_bearing: FaultyRangeBearingKeys | None = Field(
        None, alias="rangeBearing", description="A camera.", examples=[{"rangeBias": 0.1}]
    )
    range: FaultyRangeKeys | None = Field(None, description="A radio.", examples=[{"bias": 0.1}])
    bearing: FaultyBearingKeys | None = Field(None, description="A camera.", examples=[{"bias": 1}])
    gnss: FaultyGnssKeys | None = Field(
        None, description="Satellite fixes.", examples=[{"xBias": 0.1}]
    )
    pylon: FaultyPylonKeys | None = Field(
        None, description="A lidar.", examples=[{"aheadBias": 0.1}]
    )
    lidar: FaultyLidarKeys | None = Field(
        None, description="A lidar in its own frame.", examples=[{"aheadBias": 0.1}]
    )
    ultrasonic: FaultyRangeKeys | None = Field(
        None, description="Beams.", examples=[{"bias": 0.02}]
    )
    infrared: FaultyInfraredKeys | None = Field(
        None, description="Pairs.", examples=[{"bias": 0.1}]
    )
    compass: FaultyYawKeys | None = Field(None, description="A compass.", examples=[{"bias": 5}])
    gyro: FaultyYawKeys | None = Field(None, description="A gyroscope.", examples=[{"bias": 1}])


class FaultKeys(PartKeys):
    """What is wrong with the robot, and no one knows.
    The classroom's robot has the first five, others the rest.
    """

    angles: ClassVar[frozenset[str]] = frozenset({"gyro_bias", "yaw_bias"})

    range_bias: Metres = Field(
        0.0,
        alias="rangeBias",
        description="m added to every range. Only in the classroom.",
        examples=[0.1],
    )
    range_scale: Scale = Field(
        1.0,
        alias="rangeScale",
        description="Every range is multiplied by it. Only in the classroom.",
    )
    short_returns: Probability = Field(
        0.0,
        alias="shortReturns",
        description="Probability that something unknown returns the beam before the wall does. "
        "Only in the classroom.",
    )
    odometry_distance_scale: Scale = Field(
        1.0,
        alias="odometryDstScale",
        description="Every distance that the odometry measures is multiplied by it. Only in the "
        "classroom.",
    )
    odometry_angle_scale: Scale = Field(
        1.0,
        alias="odometryAngScale",
        description="Every angle that the odometry measures is multiplied by it. Only in the "
        "classroom.",
    )
    left_scale: Scale = Field(
        1.0,
        alias="leftScale",
        description="What the left wheel measures is multiplied by it: mower, pioneer, gnss.",
    )
    right_scale: Scale = Field(
        1.0,
        alias="rightScale",
        description="What the right wheel measures is multiplied by it: mower, pioneer, gnss.",
    )
    gyro_bias: Degrees = Field(
        0.0,
        alias="gyroBias",
        description="Degrees per second added to the turn rate that is measured: mower, "
        "landmarks, ranges.",
        examples=[0.05],
    )
    distance_scale: Scale = Field(
        1.0,
        alias="distanceScale",
        description="Every way or speed that is measured is multiplied by it: landmarks, ranges.",
    )
    turn_scale: Scale = Field(
        1.0,
        alias="turnScale",
        description="Every turn or turn rate that is measured is multiplied by it: landmarks, "
        "ranges.",
    )
    forward_bias: Metres = Field(
        0.0,
        alias="forwardBias",
        description="m/s² added to the forward acceleration: pylon.",
        examples=[0.1],
    )
    lateral_bias: Metres = Field(
        0.0,
        alias="lateralBias",
        description="m/s² added to the sideward acceleration: pylon.",
        examples=[0.1],
    )
    yaw_bias: Degrees = Field(
        0.0, alias="yawBias", description="Degrees added to the yaw: pylon.", examples=[1]
    )
    sensors: FaultySensorsKeys | None = Field(
        None,
        description="What is wrong with the readings of driven robots, by the sensor's name.",
        examples=[{"markers": {"azimuthBias": 1, "outliers": 0.05, "delay": 0.2}}],
    )
