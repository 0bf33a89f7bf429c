"""What every reader makes of a plan, whatever program wrote it; and what a reader is asked."""

from dataclasses import dataclass, field
from typing import Literal

from ekfsim.geometry import Array
from ekfsim.world import Landmark

Unknown = Literal["wall", "free"]
Units = Literal["degrees", "m", "cm", "mm", "in", "ft"]
METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
Start = tuple[float, float, float]  # x, y in m, θ in degrees, as people write them


@dataclass(frozen=True, slots=True)
class Asked:
    """What the user says of a plan; None is left to the reader."""

    tolerance: float | None = None  # m, how far a wall may be drawn from where the plan has it
    unknown: Unknown = "wall"  # what the cells are that nobody has seen
    start: Start | None = None  # tells which of several rooms is wanted
    units: Units | None = None  # what one of a drawing's coordinates is
    boundary: Literal["auto", "none"] = "auto"  # whether the outline about all else is the room
    outlines: Literal["solid", "walls"] = "solid"  # whether a robot can stand inside of one


@dataclass(frozen=True, slots=True)
class Outline:
    """What takes up room: an outline, m, which closes by itself; and the holes in it."""

    name: str
    points: Array  # (n, 2)
    holes: tuple[Array, ...] = ()  # (n, 2) each


@dataclass(frozen=True, slots=True)
class Line:
    """A wall without thickness, from point to point, m; it stays open."""

    name: str
    points: Array  # (n, 2)


@dataclass(frozen=True, slots=True)
class Circle:
    """A round thing, m."""

    name: str
    x: float
    y: float
    radius: float


@dataclass(frozen=True, slots=True)
class Scan:
    """The picture that a plan was read from, to be drawn below its walls."""

    grey: Array  # (rows, columns), 0 black to 1 white; row 0 is the top
    resolution: float  # m, the side of a pixel
    origin: Start  # of the lower left corner of the lower left pixel; θ in degrees, too


@dataclass(frozen=True, slots=True)
class Plan:
    """What stands where, by one plan. Names need not differ: the writer numbers those that do not.

    told : sentences on how it was read and what was left out, for the user and for the file's head
    """

    name: str
    boundary: Array | None = None  # (n, 2) m
    outlines: tuple[Outline, ...] = ()
    lines: tuple[Line, ...] = ()
    circles: tuple[Circle, ...] = ()
    landmarks: tuple[Landmark, ...] = ()
    start: Start | None = None  # where the plan itself says it
    told: tuple[str, ...] = field(default=())
    scan: Scan | None = None
    indoors: Array | None = None  # (n, 2) m, where a robot is to be put where no boundary tells
