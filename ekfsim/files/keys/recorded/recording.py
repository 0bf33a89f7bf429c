"""The keys of a commands file that tell of a recorded log."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from ekfsim.files.keys.fields import Late, Name, Strict, SystemName
from ekfsim.files.keys.recorded.topics import OriginKeys, TopicsKeys

if TYPE_CHECKING:
    from ekfsim.files.keys.recorded.columns import (
        ColumnsKeys,
        MotionKeys,
        ReadingsKeys,
        TableKeys,
        UnitsKeys,
    )
else:
    HOME = "ekfsim.files.keys.recorded.columns"
    ColumnsKeys = Annotated[Any, Late(f"{HOME}:ColumnsKeys")]
    UnitsKeys = Annotated[Any, Late(f"{HOME}:UnitsKeys")]
    MotionKeys = Annotated[Any, Late(f"{HOME}:MotionKeys")]
    ReadingsKeys = Annotated[Any, Late(f"{HOME}:ReadingsKeys")]
    TableKeys = Annotated[Any, Late(f"{HOME}:TableKeys")]

Tables = Annotated[list[ReadingsKeys], Field(title="a list of tables", min_length=1)]
TimeUnit = Literal["s", "ms", "us", "ns"]
AngleUnit = Literal["radians", "degrees"]
Targets = Literal["barcodes", "subjects"]
TurnTruth = Literal["auto", "never", "always"]
SameTime = Literal["share", "add", "first", "last"]
LogFormat = Literal[
    "pylon", "gnss", "mower", "mrclam", "ranges", "pioneer", "classroom", "log", "bag"
]
ANY: LogFormat = "log"
BAG: LogFormat = "bag"
OF_ANY_ROBOT = (ANY, BAG)  # that is driven
SYSTEM_OF: dict[str, SystemName] = {  # the system that each other format of a log records
    "pylon": "pylon",
    "gnss": "gnss",
    "mower": "mower",
    "mrclam": "landmarks",
    "ranges": "ranges",
    "pioneer": "pioneer",
    "classroom": "classroom",
}
WITH_LANDMARKS = ("mower", "mrclam", "ranges", ANY)  # formats that tell what stands where

OWN_KEYS = {  # of one kind of log alone
    ANY: ("columns", "units", "motion", "readings", "landmarks", "truth", "origin"),
    BAG: ("topics", "origin"),
}


def misfit(format: LogFormat, system: str) -> str | None:
    """The system of the world that a log of this format belongs to; None where it fits."""
    if format in OF_ANY_ROBOT:
        return None if system != "classroom" else "landmarks"
    return None if SYSTEM_OF[format] == system else SYSTEM_OF[format]


class RecordingKeys(Strict):
    """A recorded log."""

    format: LogFormat = Field(description="Who wrote the log.", examples=["pylon"])
    path: Name | None = Field(
        None,
        description="The log, a file or a folder as its format has it, relative to this file; "
        "--log wins. That of a classroom brings its world, where the file names none.",
        examples=["../logs/square.csv"],
    )
    robot: int | None = Field(
        None,
        description="Which robot of a folder with several; mrclam names its files Robot2_….",
        ge=0,
        le=1_000_000,
        examples=[2],
    )
    time_unit: TimeUnit | None = Field(
        None,
        alias="timeUnit",
        description="What one of a stamp is: s, ms, us or ns. Where absent, found by what the "
        "numbers can be.",
        examples=["ms"],
    )
    angle_unit: AngleUnit | None = Field(
        None,
        alias="angleUnit",
        description="What bearings, headings and turn rates are in: radians or degrees. Where "
        "absent, as the format has them, or found where the numbers can be nothing else.",
        examples=["degrees"],
    )
    targets: Targets | None = Field(
        None,
        description="What the measurements of mrclam name: barcodes, as they are distributed, or "
        "subjects, the numbers of the landmarks themselves. Where absent, found by what the "
        "numbers can be.",
        examples=["subjects"],
    )
    turn_truth: TurnTruth = Field(
        "auto",
        alias="turnTruth",
        description="Whether half a turn is added to the true headings of ranges: auto where they "
        "point against the first metres of travel as the odometry counts them, never or always. Of "
        "log where it says always.",
        examples=["never"],
    )
    same_time: SameTime | None = Field(
        None,
        alias="sameTime",
        description="What rows of one time and different numbers mean for the odometry of mrclam, "
        "ranges, gnss, pioneer and log: they share the time evenly, are added up, or the first or "
        "the last of them holds. Where absent, added up where one says 0 of what the other tells, "
        "else shared.",
        examples=["share"],
    )
    columns: ColumnsKeys | None = Field(
        None,
        description="log: where the columns stand in any of its tables, where they are not called "
        "as here: a name of the first line, or a number from 1.",
        examples=[{"t": "time_ns"}],
    )
    units: UnitsKeys | None = Field(
        None,
        description="log: what they are in, in any of its tables, where not in s, m, rad.",
        examples=[{"t": "ns"}],
    )
    motion: MotionKeys | None = Field(
        None,
        description="log: what the robot did, in motion.csv or odometry.csv where nothing is said.",
        examples=[{"file": "odometry.txt", "holds": "next"}],
    )
    readings: (
        Annotated[list[ReadingsKeys], Field(title="a list of tables", min_length=1)] | None
    ) = Field(
        None,
        description="log: what sensors told, in readings*.csv where nothing is said.",
        examples=[[{"sensor": "gnss", "file": "fixes.txt"}]],
    )
    landmarks: TableKeys | None = Field(
        None,
        description="log: what stands where, in landmarks.csv where nothing is said; they take "
        "the place of the world's.",
        examples=[{"file": "nodes.txt", "columns": {"id": 1, "x": 2, "y": 3}}],
    )
    truth: TableKeys | None = Field(
        None,
        description="log: where the robot truly was, in truth.csv or truth.tum where nothing is "
        "said.",
        examples=[{"file": "mocap.csv"}],
    )
    topics: TopicsKeys | None = Field(
        None,
        title="topics of a bag",
        description="bag: which topic tells what. Where absent, the only one of its type.",
        examples=[{"motion": "/odom", "fix": "/gps/fix"}],
    )
    origin: OriginKeys | None = Field(
        None,
        title="a place on the earth",
        description="bag and log: where (0, 0) is on the earth, for latitudes and longitudes; the "
        "first fix where absent.",
        examples=[{"latitude": 48.137, "longitude": 11.575}],
    )
