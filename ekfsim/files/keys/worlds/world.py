"""The keys of a world file."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag

from ekfsim.files.keys.fields import (
    MARKERS,
    Coordinate,
    Degrees,
    Late,
    Name,
    Polygon,
    Pose,
    Ratio,
    Spread,
    Strict,
    SystemName,
    Text,
    Way,
)
from ekfsim.files.keys.worlds.floor import (
    DESK,
    LANDMARK,
    WALL,
    LandmarkKeys,
    ObstacleKeys,
    WallKeys,
)

if TYPE_CHECKING:
    from ekfsim.files.keys.worlds.faults import FaultKeys
    from ekfsim.files.keys.worlds.robot import RobotKeys, ToldRobotKeys
    from ekfsim.files.keys.worlds.sensors import SensorKeys
    from ekfsim.files.keys.worlds.told import ToldSensorsKeys
else:
    FaultKeys = Annotated[Any, Late("ekfsim.files.keys.worlds.faults:FaultKeys")]
    SensorKeys = Annotated[Any, Late("ekfsim.files.keys.worlds.sensors:SensorKeys")]
    RobotKeys = Annotated[Any, Late("ekfsim.files.keys.worlds.robot:RobotKeys")]
    ToldRobotKeys = Annotated[Any, Late("ekfsim.files.keys.worlds.robot:ToldRobotKeys")]
    ToldSensorsKeys = Annotated[Any, Late("ekfsim.files.keys.worlds.told:ToldSensorsKeys")]

SEE = "See noise."
POSE = {"x": 1.0, "y": 1.0, "theta": 90}
SIGMA = {"x": 0.1, "y": 0.1, "theta": 5}
ROOM = [[0, 0], [10, 0], [10, 8], [0, 8]]
SQUARE = [[0, 0], [10, 0], [10, -10], [0, -10]]


def by_system(schema: dict[str, Any]) -> None:
    """Let the schema say what a world of each system may hold."""
    from ekfsim.files.keys.worlds.by_system import BY_SYSTEM

    schema.update(BY_SYSTEM)


class SigmaKeys(Strict):
    """Standard deviations of a pose."""

    x: Spread | None = Field(None, description="m")
    y: Spread | None = Field(None, description="m")
    theta: Degrees | None = Field(None, ge=0, description="degrees", examples=[5])


class StartKeys(Pose):
    """Where the robot starts."""

    sigma: SigmaKeys | None = Field(
        None,
        description="Standard deviations from which the true start of each run is drawn, x and y "
        "in m, theta in degrees. The first belief has the same, unless `belief` says otherwise. 0 "
        "where nothing is said. On a log of the first belief alone.",
        examples=[SIGMA],
    )


class NoiseKeys(Strict):
    """The five noise ratios:
    the standard deviation is the ratio times the magnitude of what is done or measured.
    """

    execution_distance: Ratio = Field(
        alias="executionDstSigmaRatio",
        description="Noise of the distance that the wheels drive, per metre commanded.",
    )
    execution_angle: Ratio = Field(
        alias="executionAngSigmaRatio",
        description="Noise of the angle that the robot turns, per degree commanded.",
    )
    odometry_distance: Ratio = Field(
        alias="odometryDstSigmaRatio",
        description="Noise of the distance that the odometry measures, per metre.",
        examples=[0.02],
    )
    odometry_angle: Ratio = Field(
        alias="odometryAngSigmaRatio",
        description="Noise of the angle that the odometry measures, per degree.",
        examples=[0.02],
    )
    range: Ratio = Field(
        alias="rangeSigmaRatio",
        description="Noise of the range that the laser measures, per metre.",
        examples=[0.01],
    )


class ToldNoiseKeys(Strict):
    """The noise ratios that the filter is told,
    where they differ from the true ones; any of the five.
    """

    execution_distance: Ratio | None = Field(None, alias="executionDstSigmaRatio", description=SEE)
    execution_angle: Ratio | None = Field(None, alias="executionAngSigmaRatio", description=SEE)
    odometry_distance: Ratio | None = Field(None, alias="odometryDstSigmaRatio", description=SEE)
    odometry_angle: Ratio | None = Field(None, alias="odometryAngSigmaRatio", description=SEE)
    range: Ratio | None = Field(None, alias="rangeSigmaRatio", description=SEE)


class BelievedStartKeys(Strict):
    """Where the filter believes the robot to start; what is left out is as in `start`, and on a log
    as the log tells it.
    """

    x: Coordinate | None = Field(None, description="m, to the east", examples=[1.2])
    y: Coordinate | None = Field(None, description="m, to the north", examples=[1.0])
    theta: Degrees | None = Field(
        None,
        description="Heading in degrees, counter-clockwise from +x: 90 looks north.",
        examples=[80],
    )


def kind_of_start(start: Any) -> str | None:
    """Which way a believed start is written; None for neither."""
    if isinstance(start, str):
        return "unknown"
    return "pose" if isinstance(start, dict | BelievedStartKeys) else None


BelievedStart = Annotated[
    Annotated[Literal["unknown"], Tag("unknown")] | Annotated[BelievedStartKeys, Tag("pose")],
    Discriminator(kind_of_start),
    Field(title="a pose, or the word unknown"),
]


class BeliefKeys(Strict):
    """What the filter is told, where that differs from the truth."""

    start: BelievedStart | None = Field(
        None,
        description="Where the filter believes the robot to start. `unknown`: it has no idea, and "
        "begins with particles all over the free floor of its map, with any heading; only in the "
        "classroom with a boundary, and only amcl and pf can. (`ekfsim check` also refuses a sigma "
        "of such a belief, as no schema can.)",
        examples=[POSE],
    )
    sigma: SigmaKeys | None = Field(
        None,
        description="Standard deviations of the first belief, x and y in m, theta in degrees; "
        "each left out is that of start.sigma, and where nothing is said 0 in the classroom, of a "
        "robot that is driven or was recorded its document's. Moves nothing in the truth.",
        examples=[SIGMA],
    )
    noise: ToldNoiseKeys | None = Field(
        None,
        description="Noise ratios that the filter is told. Only in the classroom.",
        examples=[{"odometryDstSigmaRatio": 0.001}],
    )
    robot: ToldRobotKeys | None = Field(
        None,
        description="What the filter is told of the robot; what is left out is as in `robot`. Not "
        "in the classroom. (`ekfsim check` also refuses skidSteer for one of the two alone, as no "
        "schema can.)",
        examples=[{"wheelSigma": 0.02}],
    )
    sensors: ToldSensorsKeys | None = Field(
        None,
        description="What the filter is told of the sensors, by their names; what is left out is "
        "as in `sensors`. Not in the classroom. (`ekfsim check` also refuses sensors that the "
        "robot does not carry, as no schema can.)",
        examples=[{"markers": {"azimuthSigma": 5}}],
    )
    missing: list[Name] | None = Field(
        None,
        description="Names of the obstacles and walls that the filter's map lacks.",
        examples=[["desk"]],
    )
    obstacles: list[ObstacleKeys] | None = Field(
        None,
        description="The filter's whole list of obstacles, in place of the true one.",
        examples=[[DESK]],
    )
    walls: list[WallKeys] | None = Field(
        None,
        description="The filter's whole list of walls that stand free, in place of the true one.",
        examples=[[WALL]],
    )
    boundary: Polygon | None = Field(
        None, description="The filter's own idea of the boundary.", examples=[ROOM]
    )


class WorldKeys(Strict):
    """What stands where, how noisy the robot is,
    and what the filter is told of both. Metres and degrees.
    """

    model_config = ConfigDict(title="ekfsim world", json_schema_extra=by_system)

    name: Name = Field(
        description="What pictures and reports call this world.", examples=["classroom"]
    )
    description: Text = Field(
        "", description="What this world is for; its first line is shown by `ekfsim list`."
    )
    system: SystemName = Field(
        "classroom",
        description="Whose robot this is: the classroom's, which obeys commands, or that of a "
        "document or a recorded log, which is driven along a way.",
        examples=["mower"],
    )
    boundary: Polygon | None = Field(
        None,
        description="The room: corners in order, [x, y] in m. Its ring is a wall. Unbounded "
        "without.",
        examples=[ROOM],
    )
    obstacles: list[ObstacleKeys] = Field(
        [],
        description="Polygons and circles that stop robots and beams; they may overlap, and cross "
        "the boundary.",
        examples=[[DESK]],
    )
    walls: list[WallKeys] = Field(
        [],
        description="Walls that stand free, each a line from point to point, [x, y] in m: they "
        "stop robots and beams, and have no inside. One with a name is {name: panel, points: [[7, "
        "0], [7, 5]]}; the others are called wall 1, wall 2, … by their places in the list.",
        examples=[[WALL]],
    )
    landmarks: list[LandmarkKeys] = Field(
        [], description="Points for the sensors that see landmarks.", examples=[[LANDMARK]]
    )
    start: StartKeys = Field(description="Where the robot truly starts.", examples=[POSE])
    noise: NoiseKeys | None = Field(
        None,
        description="The five noise ratios, all required in the classroom; the other systems have "
        "theirs in robot and sensors.",
        examples=[
            {
                "executionDstSigmaRatio": 0.05,
                "executionAngSigmaRatio": 0.05,
                "odometryDstSigmaRatio": 0.02,
                "odometryAngSigmaRatio": 0.02,
                "rangeSigmaRatio": 0.01,
            }
        ],
    )
    robot: RobotKeys | None = Field(
        None,
        description="What the robot measures of its motion; what is left out is the document's. "
        "Not in the classroom.",
        examples=[{"rate": 100, "width": 1.41}],
    )
    sensors: list[SensorKeys] | None = Field(
        None,
        description="All sensors, in place of the system's own. Not in the classroom, whose robot "
        "has a laser.",
        examples=[[{"markers": MARKERS}]],
    )
    expected_path: Way | None = Field(
        None,
        alias="expectedPath",
        description="The way that was meant to be driven: an outline that closes by itself, [x, "
        "y] in m. It is drawn, and the summary's path_rmse is measured to it.",
        examples=[SQUARE],
    )
    belief: BeliefKeys | None = Field(
        None,
        description="What the filter is told, where that differs from the truth.",
        examples=[{"start": {"x": 1.2, "y": 1.0, "theta": 80}}],
    )
    faults: FaultKeys | None = Field(
        None,
        description="What is wrong with the robot, and no one knows.",
        examples=[{"rangeBias": 0.1}],
    )
