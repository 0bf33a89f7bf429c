"""A plan → the text of a world file."""

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from ekfsim.files.maps.holes import without_holes
from ekfsim.files.maps.plan import Plan, Start
from ekfsim.geometry import Array

NOISE = {  # of the assignment, as in the template
    "executionDstSigmaRatio": 0.05,
    "executionAngSigmaRatio": 0.05,
    "odometryDstSigmaRatio": 0.02,
    "odometryAngSigmaRatio": 0.02,
    "rangeSigmaRatio": 0.01,
}
# decimals of a metre: walls that lie on one line must still do so when they are read again, to
# 1e-9 of the plan
DECIMALS = 10


def world_text(plan: Plan, start: Start, noise: Mapping[str, float], head: Iterable[str]) -> str:
    """The text of a world file; `head` becomes its first lines, as comments."""
    names = _Names()
    x, y, theta = map(_number, start)
    return "\n".join(
        [
            *(f"# {line}" for line in head),
            f"name: {json.dumps(plan.name, ensure_ascii=False)}",
            *_outline(plan, names),
            f"start: {{x: {x}, y: {y}, theta: {theta}}}",
            "noise:",
            *(f"  {key}: {_number(value)}" for key, value in noise.items()),
            "",
        ]
    )


def _outline(plan: Plan, names: "_Names") -> Iterator[str]:
    """What stands where."""
    if plan.boundary is not None:
        yield f"boundary: {_points(plan.boundary)}"
    solid = [part for one in plan.outlines for part in without_holes(one)]
    if solid or plan.circles:
        yield "obstacles:"
    for one in solid:
        yield f"  - {{name: {names.own(one.name)}, points: {_points(one.points)}}}"
    for round_one in plan.circles:
        x, y, radius = map(_number, (round_one.x, round_one.y, round_one.radius))
        circle = f"{{x: {x}, y: {y}, radius: {radius}}}"
        yield f"  - {{name: {names.own(round_one.name)}, circle: {circle}}}"
    if plan.lines:
        yield "walls:"
    for line in plan.lines:
        yield f"  - {{name: {names.own(line.name)}, points: {_points(line.points)}}}"
    if plan.landmarks:
        yield "landmarks:"
    for mark in plan.landmarks:
        yield f"  - {{id: {mark.id}, x: {_number(mark.x)}, y: {_number(mark.y)}}}"


class _Names:
    """Names that differ, quoted: of one that came before, the next is numbered."""

    def __init__(self) -> None:
        self._taken = Counter[str]({"boundary": 1})

    def own(self, name: str) -> str:
        """The name, or the first with a number that is free."""
        free, number = name, 1
        while free in self._taken:
            number = max(number, self._taken[name]) + 1
            free = f"{name} {number}"
        self._taken[name] = number
        self._taken[free] += free != name
        return json.dumps(free, ensure_ascii=False)


def _points(points: Array) -> str:
    """Points as they stand in a world file."""
    return f"[{', '.join(f'[{_number(x)}, {_number(y)}]' for x, y in points)}]"


def _number(value: float) -> str:
    """A number without digits that mean nothing.

    >>> _number(2.50000000001), _number(-0.0), _number(3)
    ('2.5', '0', '3')
    """
    rounded = round(float(value), DECIMALS) + 0.0
    return str(int(rounded)) if rounded.is_integer() else repr(rounded)
