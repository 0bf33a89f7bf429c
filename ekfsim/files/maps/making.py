"""A file with a plan → the text of a world, which is read back with all checks of a world file."""

from dataclasses import dataclass
from pathlib import Path

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.given.given import Given
from ekfsim.files.maps.plan import Asked, Plan, Start
from ekfsim.files.maps.reading import read_plan
from ekfsim.files.maps.standing import roomiest
from ekfsim.files.maps.writing import NOISE, world_text
from ekfsim.printable import in_a_line
from ekfsim.version import VERSION

SCHEMA = "yaml-language-server: $schema=world.schema.json"


@dataclass(frozen=True, slots=True)
class Made:
    """A world that was made of a plan."""

    text: str
    plan: Plan
    start: Start
    source: str  # what it was made from
    told: tuple[str, ...]  # what was assumed and left out
    summary: str  # what it holds, in a few words


def make(path: Path, shown: str, asked: Asked, name: str | None) -> Made:
    """The world of a plan. name : of the world; None is the plan's own

    Raises UsageError where the file holds no plan that is known, or a robot can stand nowhere in
    it; InputError with all mistakes in the plan.
    """
    from dataclasses import replace

    plan, what = read_plan(path, shown, asked)
    plan = plan if name is None else replace(plan, name=name)
    told = [f"{shown}: {line}" for line in plan.told]
    shapes = plan.outlines, plan.lines, plan.circles, plan.landmarks
    if plan.boundary is None and not any(shapes):
        raise UsageError(*told, f"{shown}: it holds nothing that a world can hold")
    start = asked.start or plan.start
    if start is None:
        if (chosen := roomiest(plan)) is None:
            raise UsageError(
                f"{shown}: a robot can stand nowhere in this plan; where its outlines are rooms, "
                "say --outlines walls, else see --start"
            )
        start, room = chosen
        x, y, _ = start
        told.append(
            f"{shown}: the robot starts at ({x:g}, {y:g}), where it has most room, {room:.3g} m; "
            "--start X,Y,THETA says otherwise"
        )
    noise = ", ".join(f"{value:g}" for value in NOISE.values())
    source = in_a_line(f"{what}, {shown}, by ekfsim {VERSION}")
    head = [
        SCHEMA,
        f"Made of {source}.",
        *map(in_a_line, plan.told),
        f"The noise is not the plan's: {noise} are the assignment's.",
    ]
    text = world_text(plan, start, NOISE, head)
    _check(text, shown)
    return Made(text, plan, start, source, tuple(told), _summary(plan))


def _check(text: str, shown: str) -> None:
    """Raises InputError where the world of a plan has mistakes, which are then the plan's."""
    from ekfsim.files.scenes.load import read_world

    try:
        read_world(Given.text(text)).get()
    except InputError as error:
        raise InputError(
            [Mistake(Place(shown, 0), one.field, one.wrong, one.right) for one in error.mistakes]
        ) from None


def _summary(plan: Plan) -> str:
    """What a plan holds."""
    counted = (
        (len(plan.outlines), "obstacle"),
        (len(plan.lines), "wall"),
        (len(plan.circles), "circle"),
        (len(plan.landmarks), "landmark"),
    )
    things = [f"{n} {what}{'' if n == 1 else 's'}" for n, what in counted if n]
    corners = sum(
        len(ring)
        for rings in (
            [] if plan.boundary is None else [plan.boundary],
            *((one.points, *one.holes) for one in plan.outlines),
            (line.points for line in plan.lines),
        )
        for ring in rings
    )
    room = ["a world without a boundary" if plan.boundary is None else "a room"]
    return f"{' with '.join([*room, *([', '.join(things)] if things else [])])}; {corners} corners"
