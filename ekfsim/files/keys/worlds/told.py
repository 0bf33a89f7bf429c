"""The keys of a world file that set what the filter is told of a driven robot's sensors."""

from typing import ClassVar

from pydantic import ConfigDict, Field, field_validator

from ekfsim.files.keys.fields import (
    Degrees,
    Metres,
    Positive,
    Ratio,
    Spread,
    Strict,
    Turn,
)
from ekfsim.files.keys.worlds.carried import CarriedKeys
from ekfsim.files.keys.worlds.instruments import known_colour, known_colours

SEE = "See sensors."


class ToldMarkersKeys(CarriedKeys):
    """What the filter is told of the cameras."""

    angles: ClassVar[frozenset[str]] = frozenset({"azimuth_sigma", "elevation_sigma"})

    height: Metres | None = Field(None, description=SEE, examples=[0.226])
    azimuth_sigma: Turn | None = Field(None, alias="azimuthSigma", description=SEE)
    elevation_sigma: Turn | None = Field(None, alias="elevationSigma", description=SEE)


class ToldRangeBearingKeys(CarriedKeys):
    """What the filter is told of a camera for range and bearing."""

    angles: ClassVar[frozenset[str]] = frozenset({"bearing_sigma"})

    range_sigma: Spread | None = Field(None, alias="rangeSigma", description=SEE)
    bearing_sigma: Turn | None = Field(None, alias="bearingSigma", description=SEE)


class ToldBearingKeys(CarriedKeys):
    """What the filter is told of a camera for bearings."""

    angles: ClassVar[frozenset[str]] = frozenset({"sigma"})

    sigma: Turn | None = Field(None, description=SEE)


class ToldRangeKeys(CarriedKeys):
    """What the filter is told of a radio,
    and with what its ranges are corrected before the filter gets them.
    """

    sigma: Spread | None = Field(None, description=SEE)
    scale: Positive | None = Field(None, description=SEE, examples=[1.066])
    bias: Metres | None = Field(None, description=SEE, examples=[0.11])


class ToldFixKeys(CarriedKeys):
    """What the filter is told of fixes, or of a lidar."""

    sigma: Spread | None = Field(None, description=SEE)


class ToldUltrasonicKeys(CarriedKeys):
    """What the filter is told of ultrasonic beams."""

    sigma: Spread | None = Field(None, description=SEE, examples=[0.005])
    sigma_per_metre: Ratio | None = Field(None, alias="sigmaPerMetre", description=SEE)


class ToldInfraredKeys(CarriedKeys):
    """What the filter is told of infrared pairs, and of the walls that they shine at."""

    gain: Positive | None = Field(None, description=SEE)
    offset: Metres | None = Field(None, description=SEE, examples=[1.0])
    colour: str | None = Field(
        None, description=SEE, examples=["black"], json_schema_extra=known_colours
    )
    sigma: Spread | None = Field(None, description=SEE, examples=[0.05])

    _known = field_validator("colour")(known_colour)


class ToldYawKeys(CarriedKeys):
    """What the filter is told of a gyroscope."""

    angles: ClassVar[frozenset[str]] = frozenset({"sigma"})

    sigma: Turn | None = Field(None, description=SEE, examples=[1])


class ToldCompassKeys(CarriedKeys):
    """What the filter is told of a compass."""

    angles: ClassVar[frozenset[str]] = frozenset({"sigma", "orientation"})

    sigma: Turn | None = Field(None, description=SEE, examples=[10])
    orientation: Degrees | None = Field(None, description=SEE, examples=[0])


class ToldNamedKeys(
    ToldMarkersKeys,
    ToldRangeBearingKeys,
    ToldRangeKeys,
    ToldUltrasonicKeys,
    ToldInfraredKeys,
    ToldCompassKeys,
):
    """What the filter is told of a sensor that has a name of its own: the keys of its kind."""


class ToldSensorsKeys(Strict):
    """What the filter is told of the sensors, by their names: the kind where they have no other."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, ToldNamedKeys] = Field(init=False)

    markers: ToldMarkersKeys | None = Field(
        None, description="Cameras.", examples=[{"azimuthSigma": 1}]
    )
    range_bearing: ToldRangeBearingKeys | None = Field(
        None, alias="rangeBearing", description="A camera.", examples=[{"rangeSigma": 0.1}]
    )
    range: ToldRangeKeys | None = Field(None, description="A radio.", examples=[{"sigma": 0.1}])
    bearing: ToldBearingKeys | None = Field(
        None, description="A camera.", examples=[{"sigma": 0.5}]
    )
    gnss: ToldFixKeys | None = Field(
        None, description="Satellite fixes.", examples=[{"sigma": 0.5}]
    )
    pylon: ToldFixKeys | None = Field(None, description="A lidar.", examples=[{"sigma": 0.02}])
    lidar: ToldFixKeys | None = Field(
        None, description="A lidar in its own frame.", examples=[{"sigma": 0.02}]
    )
    ultrasonic: ToldUltrasonicKeys | None = Field(
        None, description="Beams.", examples=[{"sigma": 0.05}]
    )
    infrared: ToldInfraredKeys | None = Field(
        None, description="Pairs.", examples=[{"colour": "black"}]
    )
    compass: ToldCompassKeys | None = Field(None, description="A compass.", examples=[{"sigma": 5}])
    gyro: ToldYawKeys | None = Field(None, description="A gyroscope.", examples=[{"sigma": 0.5}])
