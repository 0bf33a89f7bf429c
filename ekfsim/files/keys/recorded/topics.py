"""The keys of a recording that say which topics of a bag tell what."""

from typing import Annotated, Any

from pydantic import ConfigDict, Discriminator, Field, Tag
from pydantic.config import JsonDict

from ekfsim.files.keys.fields import Name, Strict

FRONT: JsonDict = {"topic": "/scan_front", "sensor": "front"}


class SensorTopicKeys(Strict):
    """A topic, and the sensor of the world that it is of."""

    model_config = ConfigDict(title="a topic of a sensor", json_schema_extra={"examples": [FRONT]})

    topic: Name = Field(description="Its name in the bag.", examples=["/scan_front"])
    sensor: Name | None = Field(
        None,
        description="Which sensor of the world it is, by its name or its kind, where several "
        "could be it.",
        examples=["front"],
    )
    held: bool | None = Field(
        None,
        description="Whether a fix that repeats the one before holds it, and tells nothing new. "
        "Where absent, found by how many do.",
        examples=[False],
    )


def kind_of_topic(value: Any) -> str | None:
    """Which way the topic of a sensor is written: its name, with the sensor, or several; None for
    none of these.
    """
    if isinstance(value, str):
        return "name"
    if isinstance(value, list):
        return "several"
    return "one" if isinstance(value, dict | SensorTopicKeys) else None


SensorTopics = Annotated[
    Annotated[Name, Tag("name")]
    | Annotated[SensorTopicKeys, Tag("one")]
    | Annotated[
        list[SensorTopicKeys],
        Tag("several"),
        Field(title="a list of topics", min_length=1, examples=[[FRONT]]),
    ],
    Discriminator(kind_of_topic),
    Field(title="a topic, or {topic: …, sensor: …}, or a list of those"),
]


class TopicsKeys(Strict):
    """Which topic of a bag tells what. Where absent, the only one of its type. Those of sensors may
    name the sensor, too, and be several: `scan: [{topic: /scan_front, sensor: front}, …]`.
    """

    motion: Name | None = Field(
        None,
        description="What the robot did: nav_msgs/Odometry or another pose, by what lies between "
        "two; or speeds, as geometry_msgs/TwistStamped and an Odometry without poses tell them.",
        examples=["/odom"],
    )
    fix: SensorTopics | None = Field(
        None,
        description="Satellite fixes: sensor_msgs/NavSatFix.",
        examples=["/gps/fix"],
    )
    scan: SensorTopics | None = Field(
        None,
        description="Laser scans, thinned to the beams of the world's sensor: "
        "sensor_msgs/LaserScan.",
        examples=["/scan", FRONT],
    )
    landmarks: SensorTopics | None = Field(
        None,
        description="Landmarks as a camera sees them: a list of poses with an id each.",
        examples=["/tag_detections"],
    )
    truth: Name | None = Field(
        None,
        description="True poses: nav_msgs/Odometry, geometry_msgs/PoseStamped, "
        "PoseWithCovarianceStamped or TransformStamped.",
        examples=["/ground_truth"],
    )


class OriginKeys(Strict):
    """Where (0, 0) is on the earth (WGS 84): x goes east from there, y to true north."""

    latitude: Annotated[float, Field(ge=-90, le=90)] = Field(
        description="Degrees.", examples=[48.137]
    )
    longitude: Annotated[float, Field(ge=-180, le=180)] = Field(
        description="Degrees.", examples=[11.575]
    )
