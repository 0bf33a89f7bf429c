"""The keys of what stands on a floor: obstacles, walls, landmarks."""

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import ConfigDict, Discriminator, Field, Tag
from pydantic.config import JsonDict

from ekfsim.files.keys.fields import (
    Coordinate,
    Late,
    Line,
    Name,
    Polygon,
    Positive,
    Strict,
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


DESK: JsonDict = {"name": "desk", "points": [[4, 3], [5, 3], [5, 4], [4, 4]]}


SHAPES = ("points", "circle")  # an obstacle has exactly one of them


POINTS_OR_CIRCLE: JsonDict = {"oneOf": [{"required": [shape]} for shape in SHAPES]}


CIRCLE: JsonDict = {"x": 3, "y": 2, "radius": 0.4}


WALL = [[7, 0], [7, 5]]


PANEL: JsonDict = {"name": "panel", "points": [[7, 0], [7, 5]]}


LANDMARK: JsonDict = {"id": 3, "x": 5.0, "y": -5.0}


class CircleKeys(Strict):
    """A circle."""

    model_config = ConfigDict(title="a circle")

    x: Coordinate = Field(description="Of its centre, m", examples=[3])
    y: Coordinate = Field(description="Of its centre, m", examples=[2])
    radius: Positive = Field(description="m", examples=[0.4])


class ObstacleKeys(Strict):
    """A polygon or a circle that stops robots and beams: it has either points or a circle."""

    model_config = ConfigDict(
        title="an obstacle", json_schema_extra={"examples": [DESK], **POINTS_OR_CIRCLE}
    )

    name: Name = Field(
        description="What messages and pictures call it; no two obstacles share a name."
    )
    points: Polygon | None = Field(
        None, description="Its corners in order, [x, y] in m; the outline closes by itself."
    )
    circle: CircleKeys | None = Field(
        None, description="Its centre and radius, m, where it is round.", examples=[CIRCLE]
    )


class LineKeys(Strict):
    """Walls that stand free: they stop robots and beams, and have no inside."""

    model_config = ConfigDict(title="a wall", json_schema_extra={"examples": [PANEL]})

    name: Name = Field(
        description="What messages and pictures call it; no wall and no obstacle shares it.",
        examples=["panel"],
    )
    points: Line = Field(
        description="From end to end, [x, y] in m; it stays open, and may cross itself."
    )


def kind_of_wall(wall: Any) -> str | None:
    """Which way a wall is written: its points alone, or a name as well; None for neither."""
    if isinstance(wall, list):
        return "points"
    return "named" if isinstance(wall, dict | LineKeys) else None


WallKeys = Annotated[
    Annotated[Line, Tag("points")] | Annotated[LineKeys, Tag("named")],
    Discriminator(kind_of_wall),
    Field(title="a wall", examples=[WALL]),
]


class LandmarkKeys(Strict):
    """A point that a sensor can tell apart from all others."""

    model_config = ConfigDict(title="a landmark", json_schema_extra={"examples": [LANDMARK]})

    id: int = Field(description="A number of its own.", ge=0, le=2**31 - 1, examples=[3])
    x: Coordinate = Field(description="m")
    y: Coordinate = Field(description="m")
