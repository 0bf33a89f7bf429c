"""The list of a world file's sensors: an item holds the keys of one kind."""

from pydantic import ConfigDict, Field
from pydantic.config import JsonDict

from ekfsim.files.keys.fields import MARKERS, PartKeys, Strict
from ekfsim.files.keys.worlds.instruments import (
    BearingKeys,
    CompassKeys,
    GnssKeys,
    GyroKeys,
    InfraredKeys,
    LidarKeys,
    MarkersKeys,
    PylonKeys,
    RangeBearingKeys,
    RangeKeys,
    UltrasonicKeys,
)
from ekfsim.systems.instrument import Instrument
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

ONE_SENSOR: JsonDict = {"minProperties": 1, "maxProperties": 1, "examples": [{"markers": MARKERS}]}


class SensorKeys(Strict):
    """One sensor: exactly one kind."""

    model_config = ConfigDict(title="a sensor", json_schema_extra=ONE_SENSOR)

    markers: MarkersKeys | None = Field(
        None,
        description="Cameras that tell azimuth and elevation of landmarks.",
        examples=[MARKERS],
    )
    range_bearing: RangeBearingKeys | None = Field(
        None,
        alias="rangeBearing",
        description="A camera that tells range and bearing of landmarks.",
        examples=[{"rate": 2, "range": 5}],
    )
    range: RangeKeys | None = Field(
        None,
        description="A radio that tells ranges to landmarks alone.",
        examples=[{"rate": 4, "sigma": 0.6}],
    )
    bearing: BearingKeys | None = Field(
        None,
        description="A camera that tells the bearing of landmarks alone.",
        examples=[{"rate": 2, "sigma": 1}],
    )
    gnss: GnssKeys | None = Field(
        None, description="Satellite fixes of the position.", examples=[{"rate": 10, "sigma": 0.15}]
    )
    pylon: PylonKeys | None = Field(
        None,
        description="A lidar that tells the offset of a pylon.",
        examples=[{"rate": 10, "sigma": 0.0075}],
    )
    lidar: LidarKeys | None = Field(
        None,
        description="A lidar whose offset of a pylon is read in its own frame, and corrects the "
        "heading.",
        examples=[{"rate": 10, "sigma": 0.0075}],
    )
    ultrasonic: UltrasonicKeys | None = Field(
        None, description="A ring of ultrasonic beams.", examples=[{"rate": 2, "range": 2}]
    )
    infrared: InfraredKeys | None = Field(
        None,
        description="Pairs of an infrared emitter and receiver.",
        examples=[{"rate": 2, "colour": "white"}],
    )
    compass: CompassKeys | None = Field(
        None,
        description="A compass, which tells the absolute yaw.",
        examples=[{"rate": 2, "sigma": 10}],
    )
    gyro: GyroKeys | None = Field(
        None,
        description="A gyroscope, which tells the yaw since the start.",
        examples=[{"rate": 10, "sigma": 1}],
    )

    def part(self) -> PartKeys:
        """The keys of the one kind that is written."""
        (name,) = self.model_fields_set
        held = getattr(self, name)
        assert isinstance(held, PartKeys)
        return held


SENSORS: dict[type[PartKeys], type[Instrument]] = {
    MarkersKeys: Markers,
    RangeBearingKeys: RangeBearings,
    RangeKeys: Ranges,
    BearingKeys: Bearings,
    GnssKeys: Gnss,
    PylonKeys: Pylon,
    LidarKeys: Lidar,
    UltrasonicKeys: Ultrasonic,
    InfraredKeys: Infrared,
    CompassKeys: Compass,
    GyroKeys: Gyro,
}
