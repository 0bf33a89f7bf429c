"""The keys of a study file: what `ekfsim study` is told by options, to keep and to repeat."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field, WithJsonSchema, field_validator
from pydantic_core import PydanticCustomError

from ekfsim.files.keys.fields import Name, Seed, Strict, Text
from ekfsim.files.keys.filters import filter_names, is_filter, known_filters
from ekfsim.printable import quoted

MAX_RUNS = 1_000_000_000
SWEEP: dict[str, Any] = {"noise.rangeSigmaRatio": [0.005, 0.01, 0.02], "guard": ["warn", "skip"]}
SIDE: dict[str, Any] = {"guard": "skip", "gate": 0.99, "filter": "ukf"}
SET: dict[str, Any] = {"noise.rangeSigmaRatio": 0.02}


def single(value: Any) -> Any:
    """A number or a word. Raises PydanticCustomError for a list, a mapping, and what is neither."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise PydanticCustomError("single", "no number and no word")
    return value


Value = Annotated[
    Any,
    AfterValidator(single),
    WithJsonSchema(
        {"title": "a number or a word", "type": ["number", "string"], "examples": [0.02]}
    ),
]
Values = Annotated[
    list[Value], Field(title="a list of values", min_length=1, examples=[[0.005, 0.01, 0.02]])
]
Side = dict[str, Value]
FilterName = Annotated[str, Field(examples=["ekf"], json_schema_extra=known_filters)]


class StudyKeys(Strict):
    """What to study: a commands file, how many runs of it, and which numbers are swept."""

    model_config = ConfigDict(title="ekfsim study")

    study: Name = Field(
        description="The commands file that is studied, relative to this file, or the name of one "
        "that comes along.",
        examples=["tour"],
    )
    world: Name | None = Field(
        None,
        description="A world file in place of the one that the commands file names, relative to "
        "this file, or the name of one that comes along.",
        examples=["../worlds/classroom.yaml"],
    )
    log: Name | None = Field(
        None,
        description="The recorded log that is studied, relative to this file, in place of the one "
        "that the commands file names. A recording is one run: each cell is played once, and "
        "`runs` and `seed` say nothing.",
        examples=["log"],
    )
    description: Text = Field("", description="What this study is to show.")
    runs: int = Field(
        10_000,
        description="How many runs of each cell and filter.",
        ge=1,
        le=MAX_RUNS,
        examples=[10000],
    )
    seed: Seed | None = Field(None, description="In place of the commands file's seed.")
    filters: Annotated[list[FilterName], Field(title="a list of filters", min_length=1)] | None = (
        Field(
            None,
            description="The filters that watch, in place of the commands file's; a file of one's "
            "own is named relative to this file.",
            examples=[["ekf", "ukf"]],
        )
    )
    sweep: dict[str, Values] = Field(
        {}, description="Numbers of the world file, gate or guard, each with the values that it "
                        "is to have. Several "
        "make a grid.", examples=[SWEEP],
    )  # fmt: skip
    set: dict[str, Value] = Field(
        {},
        description="Numbers of the world file in place of the world's own, for all cells.",
        examples=[SET],
    )
    gate: float | None = Field(
        None, description="In place of the commands file's gate.", gt=0, lt=1, examples=[0.99]
    )
    guard: Literal["off", "warn", "skip"] | None = Field(
        None, description="In place of the commands file's guard.", examples=["skip"]
    )
    reading: Literal["printed", "coded", "corrected"] = Field(
        "corrected",
        description="Which reading of the system's document the filter follows.",
        examples=["corrected"],
    )
    fast: bool = Field(
        False,
        description="Whether the runs are calculated by code that Numba compiles (the extra "
        "`fast`), whole for ekf, huber and pdaf in the classroom; alike but for the last digits.",
        examples=[True],
    )
    a: Side = Field(
        {}, description="What one side of `ekfsim compare` sets.", examples=[{"guard": "off"}]
    )
    b: Side = Field(
        {},
        description="What the other side sets. With a or b this file is a comparison.",
        examples=[SIDE],
    )
    ekfsim: Text = Field("", description="The version that wrote this file.", examples=["0.1.0"])

    @field_validator("filters")
    @classmethod
    def known(cls, names: list[str] | None) -> list[str] | None:
        """Filters there are. Raises PydanticCustomError for another."""
        for name in names or []:
            if not is_filter(name):
                right = f"known: {', '.join(filter_names())}, or one of your own: FILE.py"
                raise PydanticCustomError(
                    "order", "{name} is no filter; {right}", {"name": quoted(name), "right": right}
                )
        return names
