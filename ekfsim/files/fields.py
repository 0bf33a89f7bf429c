"""The kinds of value that world and commands files are made of; messages and editors read the same bounds."""

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

FAR = 1e6  # m, degrees, or times: beyond it a millimetre is lost in rounding, and squares in covariances after it


class Strict(BaseModel):
    """A mapping with known keys; nothing is converted from text."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        frozen=True,
        model_title_generator=lambda model: model.__name__.removesuffix("Keys").lower(),
    )


Metres = Annotated[float, Field(ge=-FAR, le=FAR, examples=[1.5])]
Degrees = Annotated[float, Field(ge=-FAR, le=FAR, examples=[90])]
Spread = Annotated[float, Field(ge=0, le=FAR, examples=[0.1])]
Ratio = Annotated[float, Field(ge=0, le=FAR, examples=[0.05])]
Scale = Annotated[float, Field(ge=-FAR, le=FAR, examples=[1.05])]
Probability = Annotated[float, Field(ge=0, le=1, examples=[0.1])]
Name = Annotated[str, Field(pattern=r"^[^\r\n]*\S[^\r\n]*$", examples=["desk"])]
Text = Annotated[str, Field(examples=["One room, two desks."])]

Point = Annotated[
    list[Metres], Field(title="a point [x, y]", min_length=2, max_length=2, examples=[[4, 3]], description="x, y in m")
]
Polygon = Annotated[list[Point], Field(min_length=3, examples=[[[4, 3], [5, 3], [5, 4]]])]


def in_order(share: list[float]) -> list[float]:
    """A share from low to high. Raises PydanticCustomError where it runs the other way."""
    low, high = share
    if low > high:
        raise PydanticCustomError("order", f"{low:g} is more than {high:g}; write the lower first: [{high:g}, {low:g}]")
    return share


Share = Annotated[
    list[Probability],
    Field(title="a pair [low, high]", min_length=2, max_length=2, examples=[[0.05, 0.3]]),
    AfterValidator(in_order),
]


class Pose(Strict):
    """Where something stands, and which way it looks."""

    x: Metres = Field(description="m, to the east")
    y: Metres = Field(description="m, to the north")
    theta: Degrees = Field(description="Heading in degrees, counter-clockwise from +x: 90 looks north.")
