"""The two sheets of a worksheet, in Markdown that reads as text too."""

import re
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from ekfsim.errors import UsageError
from ekfsim.filters.tuning import UNTUNED
from ekfsim.localization import play
from ekfsim.printable import shown
from ekfsim.provenance import told_in_a_line
from ekfsim.scene import Scene
from ekfsim.views.words.numbers import number, point
from ekfsim.views.worksheet.choice import calculated, chosen
from ekfsim.views.worksheet.gaps import Block, Line, Number, Told, blocks

BLANK = "_" * 9
HOW = """\
A robot drives and senses, and an extended Kalman filter follows it. Below, numbers were left out:
fill the gaps in the order of their numbers.

- Every gap can be calculated from what stands before it, the gaps that you have filled included: a
  step begins with what the step before it ended with.
- What is told twice is one gap: an entry of a covariance and its mirror image, and the estimate
  that the next move begins with.
- Lengths are in m, headings and angles in degrees; in matrices and derivatives all is in m and rad.
- Carry six digits. An answer is right within a hundredth of its standard deviation, or of itself;
  the last column of the solution says how near each must come.
"""
MAP = """\
What the beams meet, as the filter is told: corners in m. Edge 1 goes from the first corner to the
second, the last edge back to the first. A beam is predicted to end at the first edge on its way.
"""


class Sheets(NamedTuple):
    """A worksheet and its solution, and how much of it was left out."""

    sheet: str
    solution: str
    gaps: int
    numbers: int  # that can be calculated


def sheets(scene: Scene, share: float, probability: float = 0.954, explain: bool = False) -> Sheets:
    """A worksheet of a scene's run, and its solution. share : of the numbers that can be calculated

    Raises UsageError for a scene whose numbers are not the assignment's.
    """
    _refuse_what_is_not_by_the_equations(scene)
    told = list(blocks(play(scene), scene, probability, explain))
    gaps = chosen(told, share, (scene.seed, scene.run))
    numbers = calculated(told)
    if not gaps:
        raise UsageError(f"{scene.commands_source}: nothing is calculated in it: it never moves")
    made = (
        f"{told_in_a_line(scene)}: {len(gaps)} of {len(numbers)} numbers that can be calculated "
        "are gaps"
    )
    title = shown(scene.description.partition("\n")[0] or scene.commands_source)
    answers = [one for one in numbers if one.number in gaps]
    return Sheets(
        f"# Worksheet: {title}\n\n{shown(made)}\n\n{HOW}\n## The map\n\n{MAP}\n{_map(scene)}\n"
        + _narrative(told, lambda one: _gap(one, gaps)),
        f"# Solution: {title}\n\n{shown(made)}\n\n{_table(answers, gaps)}\n"
        + _narrative(told, lambda one: _filled(one, gaps)),
        len(gaps),
        len(numbers),
    )


def _refuse_what_is_not_by_the_equations(scene: Scene) -> None:
    wrong = (
        "the robot obeys no commands: a step of it is of too many numbers"
        if not scene.commanded or scene.world.robot is not None
        else "is watched by several filters; name one"
        if scene.beside
        else f"the filter is {scene.filter}; a worksheet is of ekf, by the assignment's equations"
        if scene.filter != "ekf"
        else "its filter has settings of its own; a worksheet is by the assignment's equations"
        if scene.tuning != UNTUNED
        else ""
    )
    if wrong:
        raise UsageError(f"{scene.commands_source}: {wrong}")


def _map(scene: Scene) -> str:
    rings = [
        f"{name}: {' '.join(point(x, y) for x, y in ring.tolist())}"
        for name, ring in scene.world.told.map.rings()
    ]
    rings += [
        f"{line.name}: {' '.join(point(x, y) for x, y in line.points.tolist())} (open)"
        for line in scene.world.told.map.lines
    ]
    rings += [
        f"{one.name}: a circle about {point(*one.centre.tolist())} of radius {number(one.radius)} m"
        for one in scene.world.told.map.circles()
    ]
    return _fenced(rings or ["there is no wall"])


def _narrative(told: Sequence[Block], as_text: Callable[[Told], str]) -> str:
    return "\n".join(
        f"## {'The start' if block.index == 0 else f'Step {block.index}'}\n\n"
        + _fenced(_lines(block.lines, as_text))
        for block in told
    )


def _lines(lines: Iterable[Line], as_text: Callable[[Told], str]) -> list[str]:
    """Lines as text; the columns of a matrix stand below each other."""
    text, rows = [], list[list[str]]()
    for line in (*lines, ("",)):
        if all(isinstance(part, Told) for part in line):
            rows.append([as_text(part) for part in line if isinstance(part, Told)])
            continue
        text += _matrix(rows)
        rows = []
        text.append("".join(part if isinstance(part, str) else as_text(part) for part in line))
    return text[:-1]


def _matrix(rows: Sequence[Sequence[str]]) -> list[str]:
    wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        ("[[" if i == 0 else " [")
        + "  ".join(f"{entry:>{width}}" for entry, width in zip(row, wide, strict=True))
        + ("]]" if i == len(rows) - 1 else "]")
        for i, row in enumerate(rows)
    ]


def _gap(told: Told, gaps: dict[Number, int]) -> str:
    return f"({gaps[told.number]}){BLANK}" if told.number in gaps else told.text


def _filled(told: Told, gaps: dict[Number, int]) -> str:
    return f"({gaps[told.number]}) {told.text}" if told.number in gaps else told.text


def _table(answers: Sequence[Told], gaps: dict[Number, int]) -> str:
    head = "| gap | step | number | value | right within |\n|---|---|---|---|---|\n"
    return head + "".join(
        f"| {gaps[one.number]} | {one.number.since} | {_named(one.number)} | {one.text} | "
        f"{number(float(f'{one.within:.1g}'))} |\n"
        for one in answers
        if one.number is not None
    )


def _named(what: Number) -> str:
    return f"{what.what} {what.name}".strip() if what.what != "ellipse" else what.name


def _fenced(lines: Sequence[str]) -> str:
    """Lines as a block of fixed width, which ends with it and not before."""
    longest = max(map(len, re.findall("~+", "\n".join(lines))), default=0)
    fence = "~" * max(3, longest + 1)
    return "\n".join([f"{fence}text", *lines, fence, ""])
