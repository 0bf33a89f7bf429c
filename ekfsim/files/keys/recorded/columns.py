"""The keys of a recording that say where the tables of a log are, and what their columns mean."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field, WithJsonSchema, create_model
from pydantic.alias_generators import to_camel
from pydantic.config import JsonDict
from pydantic_core import PydanticCustomError

from ekfsim.files.keys.fields import Name, Positive, Strict

COLUMNS = {  # what each column holds, and in which unit where nobody says another
    "t": "the instant, s",
    "v": "speed ahead, m/s",
    "omega": "turn rate counter-clockwise, rad/s",
    "left": "of the left wheel, its speed, m/s, or its way, m: see wheels",
    "right": "the same of the right wheel; of a lidar, how far to the right, m",
    "distance": "way ahead since the row before, m",
    "turn": "turn counter-clockwise since the row before, rad",
    "turn_before": "of an odometry that tells turn, way and turn: the turn before the way, rad",
    "ax": "acceleration ahead, m/s²",
    "ay": "acceleration to the left, m/s²",
    "yaw": "heading counter-clockwise from east that a sensor tells, rad",
    "x": "place, m: of a fix, of the truth, of a landmark, of the odometry",
    "y": "place, m",
    "latitude": "in place of x and y, on the earth: degrees north (WGS 84)",
    "longitude": "degrees east",
    "theta": "heading counter-clockwise from +x, rad: of the truth, of the odometry",
    "qx": "in place of theta, of a quaternion; of a robot on level ground qz and qw suffice",
    "qy": "of the same",
    "qz": "of the same",
    "qw": "of the same",
    "sensor": "which sensor of the world it is, by its name or its kind; a word",
    "target": "what is seen: the id or the name of a landmark, or the number of a beam",
    "range": "m",
    "bearing": "rad from straight ahead, counter-clockwise",
    "azimuth": "rad",
    "elevation": "rad",
    "ahead": "how far ahead a lidar sees something, m",
    "offset_east": "of a pylon, how far it stands to the east of the robot, m",
    "offset_north": "and how far to the north, m",
    "intensity": "of an infrared pair, V",
    "sigma": "standard deviation of this reading, in its own unit; wins over the sensor's",
    "sigma_x": "of x alone, m",
    "sigma_y": "of y alone, m",
    "sigma_range": "of the range alone, m",
    "sigma_bearing": "of the bearing alone, rad",
    "variance": "in place of sigma, its square",
    "variance_x": "of x alone, m²",
    "variance_y": "of y alone, m²",
    "variance_range": "of the range alone, m²",
    "variance_bearing": "of the bearing alone, rad²",
    "id": "of a landmark: a number or a name",
}
UNITS = {  # s, m, rad, m/s, rad/s, m/s², V that one of each is
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9,
    "m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0,
    "m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "km/h": 1 / 3.6,
    "rad": 1.0, "deg": 0.017453292519943295, "degrees": 0.017453292519943295, "radians": 1.0,
    "rad/s": 1.0, "deg/s": 0.017453292519943295, "degrees/s": 0.017453292519943295,
    "m/s²": 1.0, "m/s^2": 1.0, "g": 9.80665, "V": 1.0, "mV": 0.001,
}  # fmt: skip
OF_FIXES: JsonDict = {"examples": [{"sensor": "gnss", "columns": {"x": "easting"}}]}
THEIRS: JsonDict = {"t": "time_ns", "bearing": 4}


def place(value: Any) -> Any:
    """The name of a column, or its number from 1. Raises PydanticCustomError for what is none."""
    if isinstance(value, str) and value.strip():
        return value
    if isinstance(value, int) and not isinstance(value, bool) and value >= 1:
        return value
    raise PydanticCustomError("order", "this names no column; write its name, or its number from 1")


def target(value: Any) -> Any:
    """What is seen: a name or a number. Raises PydanticCustomError for what is none."""
    if isinstance(value, str) and value.strip():
        return value
    if isinstance(value, int) and not isinstance(value, bool) and value >= 0:
        return value
    right = "write a landmark's id or name, or the number of a beam"
    raise PydanticCustomError("order", f"this names nothing; {right}")


def unit(value: Any) -> Any:
    """A unit, or how many s, m, rad, … one is. Raises PydanticCustomError for what is none."""
    if isinstance(value, str) and value in UNITS:
        return value
    if isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < 1e12:
        return value
    known = ", ".join(UNITS)
    raise PydanticCustomError(
        "order", f"this is no unit; write one of {known}, or how many s, m or rad one is"
    )


PLACE: Any = {"title": "the name of a column, or its number", "type": ["string", "integer"]}
UNIT: Any = {"title": "a unit, or a number of s, m or rad", "type": ["string", "number"]}
Place = Annotated[Any, AfterValidator(place), WithJsonSchema({**PLACE, "examples": ["time_ns"]})]
TARGET: Any = {"title": "a landmark, or the number of a beam", "type": ["string", "integer"]}
Target = Annotated[Any, AfterValidator(target), WithJsonSchema({**TARGET, "examples": ["A1"]})]
Unit = Annotated[Any, AfterValidator(unit), WithJsonSchema({**UNIT, "examples": ["ns"]})]


def _each(name: str, told: str, kind: Any, example: object) -> Any:
    """A model with a key for each column."""
    fields: Any = {
        column: (
            kind | None,
            Field(
                None,
                alias=to_camel(column),
                description=f"{what[:1].upper()}{what[1:]}.",
                examples=[example],
            ),
        )
        for column, what in COLUMNS.items()
    }
    return create_model(name, __base__=Strict, __doc__=told, __module__=__name__, **fields)


if TYPE_CHECKING:

    class ColumnsKeys(Strict):
        """A key for each of COLUMNS."""

    class UnitsKeys(Strict):
        """The same."""
else:
    ColumnsKeys = _each(
        "ColumnsKeys",
        "Where the columns of a table stand: the name that its first line has for each, or its "
        "number from 1.",
        Place,
        "time_ns",
    )
    UnitsKeys = _each("UnitsKeys", "What the numbers of each column are in.", Unit, "ns")


class TableKeys(Strict):
    """A table of a log."""

    file: Name | None = Field(
        None,
        description="The file, beside the others of the log; one by the usual name where absent.",
        examples=["odometry.txt"],
    )
    rows: Name | None = Field(
        None,
        description="Of a file with rows of several kinds: the word with which those of this table "
        "begin. Columns then go by their numbers, and the word is number 1.",
        examples=["odom2diff"],
    )
    columns: ColumnsKeys | None = Field(
        None,
        description="Where its columns stand, where they are not called as here.",
        examples=[THEIRS],
    )
    units: UnitsKeys | None = Field(
        None, description="What they are in, where not in s, m, rad.", examples=[{"t": "ns"}]
    )


class MotionKeys(TableKeys):
    """What the robot did."""

    holds: Literal["next", "before"] | None = Field(
        None,
        description="Over which time speeds hold: until the next row (v and omega, where nothing "
        "is said), or since the row before (left and right).",
        examples=["next"],
    )
    wheels: Literal["speeds", "ways"] | None = Field(
        None,
        description="What left and right are: speeds, or ways since the row before. Where absent, "
        "ways where their unit is m, cm or mm, else speeds.",
        examples=["ways"],
    )
    width: Positive | None = Field(
        None,
        description="Between the wheels, m, where the world's robot has none: it makes a turn of "
        "left and right.",
        examples=[0.23],
    )


class ReadingsKeys(TableKeys):
    """What sensors told."""

    model_config = ConfigDict(title="a table of readings", json_schema_extra=OF_FIXES)

    sensor: Name | None = Field(
        None,
        description="Which sensor of the world it is, by its name or its kind, where no column "
        "says it.",
        examples=["gnss"],
    )
    target: Target | None = Field(
        None,
        description="What all of its rows are of, where no column says it: of a file with a column "
        "for each landmark, which is named once for each.",
        examples=["A1"],
    )
    every: int | None = Field(
        None,
        description="Of rows that tell several readings: how many columns further on the next "
        "begins, to the end of the row. The columns are those of the first.",
        ge=1,
        le=1000,
        examples=[3],
    )
    held: bool | None = Field(
        None,
        description="Whether a row that repeats the reading of the row above holds it, and tells "
        "nothing new. Where absent, found by how many rows do.",
        examples=[True],
    )
