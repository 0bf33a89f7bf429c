"""The keys of a drive: a path, or a list of speeds."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag
from pydantic.config import JsonDict

from ekfsim.files.keys.fields import FAR, Degrees, Metres, PartKeys, Positive, Strict
from ekfsim.files.keys.worlds.documents import degrees
from ekfsim.systems.drives import Circle, Spiral, Square

MAX_STEPS = 1_000_000
MAX_ROUNDS = 200  # of a spiral
STRETCH: JsonDict = {"v": 0.5, "omega": 45, "for": 2}


class PathKeys(PartKeys):
    """A path that the driver holds the robot to.
    Each path has some of these keys; each default is a document's.
    """

    angles: ClassVar[frozenset[str]] = frozenset({"turn_rate"})

    path: Literal["spiral", "square", "circle"] = Field(
        description="spiral: from the outside of a field inwards. square: straight sides and "
        "turns in place. circle: round and round.",
        examples=["spiral"],
    )
    width: Positive | None = Field(
        None,
        description=f"spiral: of the field across the first heading, m. Default {Spiral.width:g}.",
        examples=[50],
    )
    length: Positive | None = Field(
        None,
        description=f"spiral: of the field along the first heading, m. Default {Spiral.length:g}.",
        examples=[75],
    )
    spacing: Positive | None = Field(
        None,
        description=f"spiral: between two rounds, m. Default {Spiral.spacing:g}.",
        examples=[4],
    )
    duration: Positive | None = Field(
        None,
        description=f"spiral: of the whole drive, s. Default {Spiral.duration:g}.",
        examples=[549],
    )
    side: Positive | None = Field(
        None, description=f"square: of each side, m. Default {Square.side:g}.", examples=[2]
    )
    radius: Positive | None = Field(
        None, description=f"circle: m. Default {Circle.radius:g}.", examples=[2]
    )
    speed: Positive | None = Field(
        None,
        description=f"square, circle: m/s. Default {Square.speed:g} along a square, "
        f"{Circle.speed:g} round a circle.",
        examples=[0.5],
    )
    turn_rate: Positive | None = Field(
        None,
        alias="turnRate",
        description=f"square: of the turns in place, degrees per second. Default "
        f"{degrees(Square.turn_rate):g}.",
        examples=[45],
    )
    laps: Positive | None = Field(
        None,
        description="square, circle: how often round; a whole number of squares. Default 1.",
        examples=[1],
    )
    clockwise: bool = Field(
        False,
        description="Whether the turns are to the right; to the left by default.",
        examples=[True],
    )


class StretchKeys(Strict):
    """Some seconds at one speed and one turn rate."""

    model_config = ConfigDict(title="a stretch", json_schema_extra={"examples": [STRETCH]})

    speed: Metres = Field(
        0.0, alias="v", description="Speed ahead, m/s; negative drives backwards.", examples=[0.5]
    )
    turn_rate: Degrees = Field(
        0.0,
        alias="omega",
        description="Turn rate in degrees per second, counter-clockwise.",
        examples=[45],
    )
    duration: float = Field(alias="for", description="How long, s.", gt=0, le=FAR, examples=[2])


def kind_of(way: Any) -> str | None:
    """Which kind of drive a value is, None for neither."""
    if isinstance(way, dict | PathKeys):
        return "path"
    return "speeds" if isinstance(way, list) else None


WayKeys = Annotated[
    Annotated[PathKeys, Tag("path")]
    | Annotated[
        list[StretchKeys],
        Field(title="a list of speeds", min_length=1, examples=[[STRETCH]]),
        Tag("speeds"),
    ],
    Discriminator(kind_of),
]
