"""The kinds of value that world and commands files are made of;
messages and editors read the same bounds.
"""

import math
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    TypeAdapter,
)
from pydantic.config import JsonDict
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_plain_validator_function

from ekfsim.late import found
from ekfsim.seeds import MOST_SEED, REPEATS

# m, of coordinates: every grid of a map lies inside, and a double still tells 15 nm apart there
FARTHEST = 1e8
# m, degrees, or times: beyond it a millimetre is lost in rounding, and squares in covariances after
# it
FAR = 1e6


SystemName = Literal["classroom", "mower", "pioneer", "gnss", "pylon", "landmarks", "ranges"]
# examples of what is read by a Late
MARKERS: JsonDict = {"rate": 0.5, "range": 10}
SPIRAL: JsonDict = {"path": "spiral", "width": 50, "length": 75, "spacing": 4, "duration": 549}


class Strict(BaseModel):
    """A mapping with known keys; nothing is converted from text."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        frozen=True,
        # a model is built where the first file asks for it: most are of other robots
        defer_build=True,
        model_title_generator=lambda model: model.__name__.removesuffix("Keys").lower(),
    )


class PartKeys(Strict):
    """Keys of a robot, a sensor or a drive: each that is left out has the document's number."""

    angles: ClassVar[frozenset[str]] = frozenset()  # the keys whose numbers are degrees

    def given(self) -> dict[str, Any]:
        """What was written, by the names that the program has for it; angles in radians."""
        written = self.model_dump(exclude_unset=True)
        parts = {name: getattr(self, name) for name in written}
        return {
            name: part.given()
            if isinstance(part, PartKeys)
            else _inside(value, name in self.angles)
            for (name, value), part in zip(written.items(), parts.values(), strict=True)
            if value is not None
        }


def _inside(value: Any, is_angle: bool) -> Any:
    """A value as the program holds it:
    whole numbers and words as they are, lists as tuples, degrees as radians.
    """
    if isinstance(value, list):
        return tuple(_inside(one, is_angle) for one in value)
    return math.radians(value) if is_angle else value


class Late:
    """The type of a key that few files have, imported where the first file has it, or a schema is
    asked for: all that other robots are told of takes longer to import and build than a classroom
    to read. Mistakes stand where they would without it.
    """

    waits: ClassVar[bool] = True

    def __init__(self, place: str) -> None:
        self.place = place  # "module:name"

    @cached_property
    def found(self) -> Any:
        """The type itself."""
        return found(self.place)

    @cached_property
    def reader(self) -> TypeAdapter[Any]:
        """What a value of the key is read with."""
        is_model = isinstance(self.found, type) and issubclass(self.found, BaseModel)
        return TypeAdapter(self.found, config=None if is_model else Strict.model_config)

    def __get_pydantic_core_schema__(self, of: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Read by what is imported then, or at once."""
        if not Late.waits:
            return handler.generate_schema(self.found)
        return no_info_plain_validator_function(lambda value: self.reader.validate_python(value))


# whose models, parts of others, have late parts
WITH_LATE = ("ekfsim.files.keys.recorded.recording",)


def whole(model: type[BaseModel]) -> type[BaseModel]:
    """The same model, built with all that else would be imported late, as its schema tells it; and
    so are those parts of it that are built by themselves already.
    """
    homes = (model.__module__, *WITH_LATE)
    parts = [one for one in Strict.__subclasses__() if one.__module__ in homes]
    Late.waits = False
    try:
        for one in parts:  # in the order of the module, so that the model itself comes last
            if one is model or one.__pydantic_complete__:
                one.model_rebuild(force=True)
    finally:
        Late.waits = True
    return model


def aliases(model: type[BaseModel]) -> dict[str, str]:
    """The keys of a file by the names that the program has for them."""
    return {name: field.alias or name for name, field in model.model_fields.items()}


def keys_of_kind(sensors: type[BaseModel], kind: str) -> type[PartKeys]:
    """The keys that a mapping of sensors by their kinds has for one of them."""
    field = next(
        field for name, field in sensors.model_fields.items() if kind in (name, field.alias)
    )
    found: type[PartKeys] = next(
        part for part in get_args(field.annotation) if issubclass(part, PartKeys)
    )
    return found


Coordinate = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST, examples=[1.5])]
Metres = Annotated[float, Field(ge=-FAR, le=FAR, examples=[1.5])]
Degrees = Annotated[float, Field(ge=-FAR, le=FAR, examples=[90])]
Spread = Annotated[float, Field(ge=0, le=FAR, examples=[0.1])]
Ratio = Annotated[float, Field(ge=0, le=FAR, examples=[0.05])]
# degrees or degrees per second: how far it spreads
Turn = Annotated[float, Field(ge=0, le=FAR, examples=[2.5])]
Positive = Annotated[float, Field(gt=0, le=FAR, examples=[1.5])]
Rate = Annotated[float, Field(gt=0, le=FAR, examples=[10])]
Scale = Annotated[float, Field(ge=-FAR, le=FAR, examples=[1.05])]
Probability = Annotated[float, Field(ge=0, le=1, examples=[0.1])]
Seed = Annotated[
    int,
    Field(
        ge=0,
        le=MOST_SEED,
        examples=[7],
        json_schema_extra={"$comment": REPEATS},
    ),
]
Name = Annotated[str, Field(pattern=r"^[^\r\n]*\S[^\r\n]*$", examples=["desk"])]
Text = Annotated[str, Field(examples=["One room, two desks."])]

Point = Annotated[
    list[Coordinate],
    Field(
        title="a point [x, y]",
        min_length=2,
        max_length=2,
        examples=[[4, 3]],
        description="x, y in m",
    ),
]
Polygon = Annotated[
    list[Point], Field(title="a polygon", min_length=3, examples=[[[4, 3], [5, 3], [5, 4]]])
]
Line = Annotated[list[Point], Field(title="a wall", min_length=2, examples=[[[7, 0], [7, 5]]])]
Way = Annotated[
    list[Point], Field(title="a way", min_length=2, examples=[[[0, 0], [10, 0], [10, -10]]])
]


def in_order(share: list[float]) -> list[float]:
    """A share from low to high. Raises PydanticCustomError where it runs the other way."""
    low, high = share
    if low > high:
        raise PydanticCustomError(
            "order", f"{low:g} is more than {high:g}; write the lower first: [{high:g}, {low:g}]"
        )
    return share


Share = Annotated[
    list[Probability],
    Field(title="a pair [low, high]", min_length=2, max_length=2, examples=[[0.05, 0.3]]),
    AfterValidator(in_order),
]


class Pose(Strict):
    """Where something stands, and which way it looks."""

    x: Coordinate = Field(description="m, to the east")
    y: Coordinate = Field(description="m, to the north")
    theta: Degrees = Field(
        description="Heading in degrees, counter-clockwise from +x: 90 looks north."
    )
