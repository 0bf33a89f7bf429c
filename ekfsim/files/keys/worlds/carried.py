"""The keys of any sensor: where it sits, when it is read, which way it looks."""

from typing import Annotated, ClassVar

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from ekfsim.files.keys.fields import (
    Degrees,
    Metres,
    PartKeys,
    Spread,
)

NAME = r"^[A-Za-z][A-Za-z0-9_-]*$"


Bearing = Annotated[float, Field(ge=-360, le=360, examples=[45])]


def turned_on(view: list[float]) -> list[float]:
    """A view from one bearing to a greater one. Raises PydanticCustomError where it is none."""
    start, end = view
    if start >= end:
        right = (
            f"write the bearing to its right first, e.g. [{end:g}, "
            f"{start if start > end else end + 60:g}]"
        )
        raise PydanticCustomError("order", f"{start:g} is not less than {end:g}; {right}")
    if end - start > 360:
        raise PydanticCustomError(
            "order", f"{end - start:g} degrees are more than all round; write [-180, 180]"
        )
    return view


View = Annotated[
    list[Bearing],
    Field(title="a pair [from, to]", min_length=2, max_length=2, examples=[[-30, 30]]),
    AfterValidator(turned_on),
]


Views = Annotated[
    list[View],
    Field(
        title="a list of views",
        min_length=1,
        examples=[[[-30, 30], [150, 210]]],
        description="Fields of view, each [from, to] in degrees from straight ahead, "
        "counter-clockwise.",
    ),
]


Beams = Annotated[
    list[Bearing],
    Field(
        title="a list of bearings",
        min_length=1,
        examples=[[-90, 0, 90]],
        description="Where the beams point, in degrees from straight ahead, counter-clockwise.",
    ),
]


class MountKeys(PartKeys):
    """Where a sensor sits on its robot, and which way it looks there."""

    angles: ClassVar[frozenset[str]] = frozenset({"theta"})

    x: Metres = Field(0.0, description="m ahead of the point that the state tells of.")
    y: Metres = Field(0.0, description="m to the left of it.")
    theta: Degrees = Field(
        0.0, description="Degrees from straight ahead, counter-clockwise.", examples=[90]
    )


class CarriedKeys(PartKeys):
    """What the filter may be told of any sensor."""

    mount: MountKeys | None = Field(
        None,
        description="Where it sits on the robot and which way it looks there, in the robot's "
        "frame: x ahead and y to the left in m, theta in degrees counter-clockwise; each left out "
        "is 0.",
        examples=[{"x": 0.3, "y": 0.1, "theta": 90}],
    )
    delay: Spread = Field(
        0.0,
        description="How old a reading is when it is stamped, s. The filter knows: a reading of "
        "the stamp t is used at t − delay.",
        examples=[0.2],
    )


class InstrumentKeys(CarriedKeys):
    """What may be said of any sensor."""

    label: Annotated[str, Field(pattern=NAME, examples=["rear"])] | None = Field(
        None,
        alias="name",
        description="What it is called, where there are several of a kind: a letter, then "
        "letters, digits, - and _. Default: its kind.",
    )
