"""The keys of a homework file: what `ekfsim grade` looks for in each submission, and for how many
points.
"""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field
from pydantic.config import JsonDict
from pydantic_core import PydanticCustomError

from ekfsim.files.keys.fields import Name, Seed, Strict, Text

CENTS = 100  # points are counted in hundredths, so that shares of them add up
MOST_POINTS = 10_000
KINDS = ("steps", "jacobians", "honesty", "inputs")  # exactly one of them makes a part
STEPS: JsonDict = {"scenes": ["tour"], "runs": 5}
ONE_KIND: JsonDict = {
    "oneOf": [{"required": [kind]} for kind in KINDS],
    "examples": [{"name": "Each step", "points": 40, "steps": STEPS}],
}
ONE_AT_LEAST: JsonDict = {"anyOf": [{"required": ["files"]}, {"required": ["exposed"]}]}
ONCE: JsonDict = {"uniqueItems": True}
Visibility = Literal["visible", "hidden", "after_due_date", "after_published"]
Equation = Annotated[
    Literal["f", "F", "G", "M", "Q", "h", "H", "R", "residual"], Field(examples=["f"])
]
Jacobian = Annotated[Literal["F", "G", "H"], Field(examples=["F"])]
Partial = Literal["halves", "steps", "none"]
Reference = Literal["ekf", "kf", "iekf", "ukf"]


def in_hundredths(points: float) -> float:
    """Points that are so many hundredths. Raises PydanticCustomError for others."""
    if abs(points * CENTS - round(points * CENTS)) > 1e-6:
        right = f"write {round(points, 2):g}"
        raise PydanticCustomError("order", f"{points:g} is finer than hundredths; {right}")
    return points


def once(words: list[Any]) -> list[Any]:
    """A list of different words. Raises PydanticCustomError where one stands twice."""
    for n, word in enumerate(words):
        if word in words[:n]:
            raise PydanticCustomError(
                "order", "{word} stands twice; delete one", {"word": repr(word)}
            )
    return words


Points = Annotated[float, Field(ge=0, le=MOST_POINTS, examples=[40]), AfterValidator(in_hundredths)]
Scenes = Annotated[
    list[Name],
    Field(
        title="a list of scenes",
        min_length=1,
        examples=[["tour", "square"]],
        json_schema_extra=ONCE,
    ),
    AfterValidator(once),
]
Runs = Annotated[int, Field(ge=1, le=1000, examples=[20])]


class StepsKeys(Strict):
    """Each step against the reference, from the student's own belief.
    Each scene is a test of its own.
    """

    scenes: Scenes = Field(
        description="Commands files, relative to this file, or names of some that come along. "
        "The points are shared out evenly."
    )
    runs: Runs = Field(1, description="How many runs of each scene; run 0 is the first.")
    against: Reference = Field(
        "ekf", description="The reference: the filter that the students write.", examples=["ekf"]
    )
    partial: Partial = Field(
        "halves",
        description="halves: half of the points for the share of moves that are right, half for "
        "that of readings. steps: by the share of all steps. none: all steps, or nothing.",
        examples=["halves"],
    )


class JacobiansKeys(Strict):
    """The student's own derivatives, functions in the same file, beside numerical ones.
    Each is a test of its own.
    """

    functions: Annotated[
        list[Jacobian],
        Field(
            title="a list of functions",
            min_length=1,
            examples=[["F", "G", "H"]],
            json_schema_extra=ONCE,
        ),
        AfterValidator(once),
    ] = Field(description="Which: F(x, u, motion), G(x, u, motion), H(x, sensor).")
    scenes: Scenes = Field(description="Where: at the beliefs of the reference along these scenes.")


class HonestyKeys(Strict):
    """Whether the filter is as sure as it may be: many runs, the same for everybody.
    Each scene is a test of its own.
    """

    scenes: Scenes = Field(description="Scenes in which the reference itself is honest.")
    runs: Annotated[int, Field(ge=20, le=10_000, examples=[100])] = Field(
        100, description="How many runs of each scene, the same for every student."
    )


class InputsKeys(Strict):
    """The student's own commands files, beside the filter."""

    model_config = ConfigDict(json_schema_extra=ONE_AT_LEAST)

    files: int | None = Field(
        None,
        description="So many files whose `expect` the reference keeps are worth all points.",
        ge=1,
        le=100,
        examples=[3],
    )
    exposed: int | None = Field(
        None,
        description="So many of the known mistakes exposed by them are worth all points. With "
        "`files`, each is worth half.",
        ge=1,
        le=1000,
        examples=[100],
    )
    runs: Runs = Field(300, description="Of each study of an `expect` at most so many runs.")
    commands: int = Field(
        1000,
        description="Of each file at most so many commands, repetitions written out.",
        ge=1,
        le=100_000,
        examples=[1000],
    )


PartKeys = StepsKeys | JacobiansKeys | HonestyKeys | InputsKeys


class HomeworkPartKeys(Strict):
    """One part: exactly one of steps, jacobians, honesty, inputs."""

    model_config = ConfigDict(title="a part", json_schema_extra=ONE_KIND)

    name: Name = Field(description="How reports call it.", examples=["Each step"])
    points: Points = Field(description="For all of it, in hundredths at the finest.")
    visibility: Visibility = Field(
        "visible", description="When Gradescope shows it to students.", examples=["visible"]
    )
    steps: StepsKeys | None = Field(
        None, description="Each step against the reference.", examples=[STEPS]
    )
    jacobians: JacobiansKeys | None = Field(
        None,
        description="The student's own derivatives.",
        examples=[{"functions": ["F", "G", "H"], "scenes": ["tour"]}],
    )
    honesty: HonestyKeys | None = Field(
        None,
        description="Whether the filter is as sure as it may be.",
        examples=[{"scenes": ["tour"], "runs": 100}],
    )
    inputs: InputsKeys | None = Field(
        None,
        description="The student's own commands files.",
        examples=[{"files": 3, "exposed": 10}],
    )

    @property
    def asks_for(self) -> PartKeys:
        """The one of the four that a part without a mistake has."""
        kinds = self.steps, self.jacobians, self.honesty, self.inputs
        (one,) = (keys for keys in kinds if keys is not None)
        return one


class LimitsKeys(Strict):
    """What a student's code may take."""

    seconds: Annotated[float, Field(gt=0, le=3600, examples=[60])] = Field(
        60.0,
        description="Of CPU, for each test: what its process calculates itself, however busy the "
        "machine is. Who sleeps is waited for 4 times as long and 20 s.",
    )
    memory: Annotated[int, Field(ge=512, le=65536, examples=[512])] = Field(
        512, description="MiB of address space, of each of its processes."
    )


class HomeworkKeys(Strict):
    """What is graded, and for how many points."""

    model_config = ConfigDict(title="ekfsim homework")

    homework: Name = Field(description="Its title.", examples=["EKF localization"])
    description: Text = Field("", description="What it is about.")
    total: Points = Field(
        description="The points of all parts together, to be sure that none was forgotten.",
        examples=[100],
    )
    filter: Name | None = Field(
        None,
        description="The name of the file with the filter in a submitted folder; where absent, "
        "its only .py.",
        examples=["filter.py"],
        json_schema_extra={"pattern": r"^(?!/).*\.py$"},
    )
    provided: (
        Annotated[
            list[Equation],
            Field(title="a list of equations", json_schema_extra=ONCE),
            AfterValidator(once),
        ]
        | None
    ) = Field(
        None,
        description='What motion and sensor hand out; asking for another is told as "write this '
        'one yourself". All where absent.',
        examples=[["f", "h"]],
    )
    seed: Seed | None = Field(
        None, description="In place of the scenes' own: others than the students have seen."
    )
    limits: LimitsKeys = Field(
        LimitsKeys(),
        description="What a student's code may take.",
        examples=[{"seconds": 60, "memory": 512}],
    )
    parts: Annotated[list[HomeworkPartKeys], Field(title="a list of parts", min_length=1)] = Field(
        description="What is graded, in this order.",
        examples=[[{"name": "Each step", "points": 100, "steps": STEPS}]],
    )
