"""The keys of a commands file."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import ConfigDict, Field, field_validator
from pydantic.config import JsonDict
from pydantic_core import PydanticCustomError

from ekfsim.files.keys.fields import (
    SPIRAL,
    Degrees,
    Late,
    Metres,
    Name,
    Pose,
    Probability,
    Seed,
    Share,
    Strict,
    Text,
)
from ekfsim.files.keys.filters import TuningKeys, is_filter, known_filters
from ekfsim.files.keys.recorded.recording import RecordingKeys

if TYPE_CHECKING:
    from ekfsim.files.keys.drive import WayKeys
else:
    WayKeys = Annotated[Any, Late("ekfsim.files.keys.drive:WayKeys")]

MAX_COMMANDS = 1_000_000
MOVE: JsonDict = {"distance": 1.75, "angle": 90}
WAYS = ("commands", "drive", "recording")  # exactly one of them makes a file a commands file
ONE_WAY: JsonDict = {"oneOf": [{"required": [way]} for way in WAYS]}
ONE_COMMAND: JsonDict = {"minProperties": 1, "maxProperties": 1, "examples": [{"move": MOVE}]}


class MoveKeys(Strict):
    """Drive straight ahead, then turn in place."""

    distance: Metres = Field(description="m straight ahead; negative drives backwards.")
    angle: Degrees = Field(
        description="Degrees of the turn that follows, counter-clockwise; negative is clockwise."
    )
    slip: Probability = Field(
        0.0,
        description="Share of the way that the wheels turn without moving the robot, from 0 to 1.",
        examples=[0.8],
    )


class SenseKeys(Strict):
    """Measure the range to the first wall."""

    angle: Degrees = Field(
        description="Direction of the laser in degrees from straight ahead, counter-clockwise."
    )


class KidnapKeys(Pose):
    """Carry the true robot to another place, and tell the filter nothing."""


class RepeatKeys(Strict):
    """The same commands several times over."""

    times: int = Field(description="How often, 0 or more.", ge=0, le=MAX_COMMANDS, examples=[4])
    commands: "list[CommandKeys]" = Field(
        description="What is repeated, in order.", examples=[[{"move": MOVE}]]
    )


class CommandKeys(Strict):
    """One command: exactly one of move, sense, repeat, kidnap, say."""

    model_config = ConfigDict(title="a command", json_schema_extra=ONE_COMMAND)

    move: MoveKeys | None = Field(
        None, description="Drive straight ahead, then turn in place.", examples=[MOVE]
    )
    sense: SenseKeys | None = Field(
        None, description="Measure the range to the first wall.", examples=[{"angle": 90}]
    )
    repeat: RepeatKeys | None = Field(
        None,
        description="The same commands several times over; may nest.",
        examples=[{"times": 4, "commands": [{"move": MOVE}]}],
    )
    kidnap: KidnapKeys | None = Field(
        None,
        description="Carry the true robot to another place, and tell the filter nothing.",
        examples=[{"x": 3, "y": 2, "theta": 0}],
    )
    say: Text | None = Field(
        None,
        description="A text for the narrative and the picture.",
        examples=["Now watch the ellipse."],
    )


class ExpectKeys(Strict):
    """What a study of this scene must find; `ekfsim study` ends with status 1 where it does not."""

    lost: Share | None = Field(
        None, description="Share of runs that are lost at the end: [low, high]."
    )
    nis: Literal["silent", "high", "low"] | None = Field(
        None,
        description="silent: fewer than 40 % of single runs have a NIS sum outside its 95 % band; "
        "high, low: at least 40 % lie above, below.",
        examples=["silent"],
    )
    nees: Literal["silent", "high", "low"] | None = Field(
        None,
        description="silent: fewer than 20 % of runs end with a NEES outside its 95 % bounds; "
        "high, low: at least 20 % end above, below.",
        examples=["high"],
    )
    coverage: Share | None = Field(
        None,
        description="Share of runs whose true position lies inside the ellipse: [low, high].",
        examples=[[0.5, 0.9]],
    )
    runs: int = Field(
        300, description="Number of runs of the study.", ge=1, le=10_000_000, examples=[300]
    )


class CommandsKeys(Strict):
    """A world, what is done in it or was recorded of it,
    and the settings of the filter. Metres and degrees.
    """

    model_config = ConfigDict(title="ekfsim commands", json_schema_extra=ONE_WAY)

    world: Name | None = Field(
        None,
        description="The world file, relative to this file, or the bare name of one that comes "
        "along; a world named on the command line wins.",
        examples=["../worlds/classroom.yaml"],
    )
    seed: Seed = Field(0, description="Whole number below 2³² that fixes all noise; --seed wins.")
    filter: str = Field(
        "ekf",
        description="Name of the filter, or the place of one of your own: FILE.py or FILE.py:Name, "
        "relative to this file, or package.module:Name; --filter wins.",
        examples=["ekf"],
        json_schema_extra=known_filters,
    )
    filter_settings: TuningKeys | None = Field(
        None,
        alias="filterSettings",
        title="settings of a filter",
        description="Numbers that the filter alone has; --set filter.particles=10000 wins.",
        examples=[{"particles": 10000}],
    )
    gate: float | None = Field(
        None,
        description="Refuse readings whose NIS lies beyond this quantile of χ²; off where absent.",
        gt=0,
        lt=1,
        examples=[0.99],
    )
    guard: Literal["off", "warn", "skip"] = Field(
        "warn",
        description="What to do with an ambiguous beam: nothing, warn, or leave the reading out.",
        examples=["warn"],
    )
    description: Text = Field(
        "", description="What this scene shows; its first line is shown by `ekfsim list`."
    )
    expect: ExpectKeys | None = Field(
        None,
        description="What a study of this scene must find.",
        examples=[{"lost": [0.05, 0.3], "nis": "silent"}],
    )
    commands: list[CommandKeys] | None = Field(
        None,
        description="What the robot does, in order. Only in the classroom.",
        examples=[[{"move": MOVE}]],
    )
    drive: WayKeys | None = Field(
        None,
        title="a drive",
        description="The way that the robot is driven, by its path or as a list of speeds. Not in "
        "the classroom.",
        examples=[SPIRAL],
    )
    recording: RecordingKeys | None = Field(
        None,
        description="A recorded log, in place of a simulation.",
        examples=[{"format": "pylon", "path": "../logs/square.csv"}],
    )

    @field_validator("filter")
    @classmethod
    def known(cls, name: str) -> str:
        """A filter there is. Raises PydanticCustomError for another."""
        if not is_filter(name):
            raise PydanticCustomError("literal_error", "unknown filter", {"expected": ""})
        return name
