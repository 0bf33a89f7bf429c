"""The keys of each kind of sensor;
each default is that of the instrument, which is the document's number.
"""

from typing import Any, ClassVar

from pydantic import Field, field_validator
from pydantic_core import PydanticCustomError

from ekfsim.files.keys.fields import (
    Degrees,
    Metres,
    Positive,
    Rate,
    Ratio,
    Spread,
    Turn,
)
from ekfsim.files.keys.worlds.carried import Beams, InstrumentKeys, Views
from ekfsim.files.keys.worlds.documents import degrees
from ekfsim.models.sensors.infrared import COLOURS
from ekfsim.systems.instruments import (
    Bearings,
    Compass,
    Gnss,
    Gyro,
    Infrared,
    Lidar,
    Markers,
    Pylon,
    RangeBearings,
    Ranges,
    Ultrasonic,
)

READ = "How often it is read, in Hz."
FARTHEST = "How far it sees, in m."
NEAREST = "What is nearer is not measured, m."


class MarkersKeys(InstrumentKeys):
    """Cameras that tell azimuth and elevation of surveyed markers."""

    angles: ClassVar[frozenset[str]] = frozenset({"azimuth_sigma", "elevation_sigma", "views"})

    rate: Rate = Field(Markers.rate, description=READ)
    height: Metres = Field(
        Markers.height, description="Of the camera above the markers, m.", examples=[0.226]
    )
    azimuth_sigma: Turn = Field(
        degrees(Markers.azimuth_sigma),
        alias="azimuthSigma",
        description="Standard deviation of the azimuth, degrees.",
    )
    elevation_sigma: Turn = Field(
        degrees(Markers.elevation_sigma),
        alias="elevationSigma",
        description="Standard deviation of the elevation, degrees.",
    )
    farthest: Positive = Field(Markers.farthest, alias="range", description=FARTHEST, examples=[10])
    views: Views = Field(degrees(Markers.views), examples=[[[-30, 30], [150, 210]]])


class RangeBearingKeys(InstrumentKeys):
    """A camera that tells range and bearing of landmarks."""

    angles: ClassVar[frozenset[str]] = frozenset({"bearing_sigma", "views"})

    rate: Rate = Field(RangeBearings.rate, description=READ)
    range_sigma: Spread = Field(
        RangeBearings.range_sigma,
        alias="rangeSigma",
        description="Standard deviation of the range, m.",
    )
    bearing_sigma: Turn = Field(
        degrees(RangeBearings.bearing_sigma),
        alias="bearingSigma",
        description="Standard deviation of the bearing, degrees.",
    )
    farthest: Positive = Field(
        RangeBearings.farthest, alias="range", description=FARTHEST, examples=[5]
    )
    views: Views = Field(degrees(RangeBearings.views), examples=[[[-35, 35]]])


class BearingKeys(InstrumentKeys):
    """A camera that tells the bearing of landmarks alone."""

    angles: ClassVar[frozenset[str]] = frozenset({"sigma", "views"})

    rate: Rate = Field(Bearings.rate, description=READ)
    sigma: Turn = Field(
        degrees(Bearings.sigma), description="Standard deviation of the bearing, degrees."
    )
    farthest: Positive = Field(Bearings.farthest, alias="range", description=FARTHEST, examples=[5])
    views: Views = Field(degrees(Bearings.views), examples=[[[-35, 35]]])


class RangeKeys(InstrumentKeys):
    """A radio that tells the range to nodes alone.
    It says scale · range + bias, and is corrected before use.
    """

    angles: ClassVar[frozenset[str]] = frozenset({"views"})

    rate: Rate = Field(Ranges.rate, description=READ)
    sigma: Spread = Field(Ranges.sigma, description="Standard deviation of the corrected range, m.")
    scale: Positive = Field(
        Ranges.scale, description="What it says grows by so much per metre.", examples=[1.066]
    )
    bias: Metres = Field(
        Ranges.bias, description="What it says too much at any range, m.", examples=[0.11]
    )
    farthest: Positive = Field(Ranges.farthest, alias="range", description=FARTHEST, examples=[100])
    views: Views = Field(degrees(Ranges.views), examples=[[[-180, 180]]])


class GnssKeys(InstrumentKeys):
    """Satellite fixes of the position."""

    rate: Rate = Field(Gnss.rate, description=READ)
    sigma: Spread = Field(Gnss.sigma, description="Standard deviation of x and of y, m.")


class PylonKeys(InstrumentKeys):
    """A lidar that tells the offset of a pylon."""

    angles: ClassVar[frozenset[str]] = frozenset({"views"})

    rate: Rate = Field(Pylon.rate, description=READ)
    sigma: Spread = Field(
        Pylon.sigma, description="Standard deviation of the offset, ahead and aside, m."
    )
    farthest: Positive = Field(Pylon.farthest, alias="range", description=FARTHEST, examples=[100])
    views: Views = Field(degrees(Pylon.views), examples=[[[-180, 180]]])


class LidarKeys(InstrumentKeys):
    """A lidar that tells how far to the right and ahead of the robot a pylon stands,
    and so corrects the heading.
    """

    angles: ClassVar[frozenset[str]] = frozenset({"views"})

    rate: Rate = Field(Lidar.rate, description=READ)
    sigma: Spread = Field(
        Lidar.sigma, description="Standard deviation of the offset, ahead and aside, m."
    )
    farthest: Positive = Field(Lidar.farthest, alias="range", description=FARTHEST, examples=[100])
    views: Views = Field(degrees(Lidar.views), examples=[[[-180, 180]]])


class UltrasonicKeys(InstrumentKeys):
    """A ring of ultrasonic beams, whose error grows with the distance."""

    angles: ClassVar[frozenset[str]] = frozenset({"bearings"})

    rate: Rate = Field(Ultrasonic.rate, description=READ)
    bearings: Beams = Field(degrees(Ultrasonic.bearings), examples=[[-90, -45, 0, 45, 90]])
    sigma: Spread = Field(
        Ultrasonic.sigma, description="Standard deviation at no distance, m.", examples=[0.005]
    )
    sigma_per_metre: Ratio = Field(
        Ultrasonic.sigma_per_metre,
        alias="sigmaPerMetre",
        description="By how much it grows per metre.",
    )
    nearest: Spread = Field(Ultrasonic.nearest, description=NEAREST)
    farthest: Positive = Field(
        Ultrasonic.farthest, alias="range", description=FARTHEST, examples=[2]
    )


def known_colours(schema: dict[str, Any]) -> None:
    """Let the schema list the colours."""
    schema["enum"] = list(COLOURS)


def known_colour(name: str) -> str:
    """A colour there is. Raises PydanticCustomError for another."""
    if name not in COLOURS:
        raise PydanticCustomError("literal_error", "unknown colour", {"expected": ""})
    return name


class InfraredKeys(InstrumentKeys):
    """Pairs of an infrared emitter and receiver, whose intensity falls with the distance."""

    angles: ClassVar[frozenset[str]] = frozenset({"bearings"})

    rate: Rate = Field(Infrared.rate, description=READ)
    bearings: Beams = Field(degrees(Infrared.bearings), examples=[[-90, 0, 90]])
    gain: Positive = Field(
        Infrared.gain, description="By how many V the intensity falls per e-fold of the distance."
    )
    offset: Metres = Field(
        Infrared.offset, description="The intensity at 1 m from a white wall, V.", examples=[1.0]
    )
    colour: str = Field(
        Infrared.colour,
        description="Of the walls.",
        examples=["white"],
        json_schema_extra=known_colours,
    )
    sigma: Spread = Field(
        Infrared.sigma, description="Standard deviation of the intensity, V.", examples=[0.05]
    )
    nearest: Positive = Field(Infrared.nearest, description=NEAREST)
    farthest: Positive = Field(
        Infrared.farthest, alias="range", description=FARTHEST, examples=[1.5]
    )

    _known = field_validator("colour")(known_colour)


class CompassKeys(InstrumentKeys):
    """A compass, which tells the absolute yaw."""

    angles: ClassVar[frozenset[str]] = frozenset({"sigma", "orientation"})

    rate: Rate = Field(Compass.rate, description=READ)
    sigma: Turn = Field(
        degrees(Compass.sigma), description="Standard deviation of the yaw, degrees.", examples=[10]
    )
    orientation: Degrees = Field(
        degrees(Compass.orientation),
        description="What it tells where the robot looks along +x, degrees.",
    )


class GyroKeys(InstrumentKeys):
    """A gyroscope, which tells the yaw since it was set to 0 along the mark,
    the heading of `start`.
    """

    angles: ClassVar[frozenset[str]] = frozenset({"sigma"})

    rate: Rate = Field(Gyro.rate, description=READ)
    sigma: Turn = Field(
        degrees(Gyro.sigma), description="Standard deviation of the yaw, degrees.", examples=[1]
    )
