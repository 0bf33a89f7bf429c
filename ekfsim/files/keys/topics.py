"""The keys of a recording that say which topics of a bag tell what."""

from typing import Annotated

from pydantic import Field

from ekfsim.files.keys.fields import Name, Strict


class TopicsKeys(Strict):
    """Which topic of a bag tells what. Where absent, the only one of its type."""

    motion: Name | None = Field(
        None,
        description="What the robot did: nav_msgs/Odometry, by its poses, or by its speeds where "
        "all poses are 0; or geometry_msgs/TwistStamped.",
        examples=["/odom"],
    )
    fix: Name | None = Field(
        None, description="Satellite fixes: sensor_msgs/NavSatFix.", examples=["/gps/fix"]
    )
    scan: Name | None = Field(
        None,
        description="Laser scans, thinned to the beams of the world's sensor: "
        "sensor_msgs/LaserScan.",
        examples=["/scan"],
    )
    landmarks: Name | None = Field(
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
