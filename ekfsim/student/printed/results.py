"""Results of a program in another language beside the run that they are of: which row is of which
step, and in which units.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.student.printed.digits import Halves
from ekfsim.student.printed.table import Row, Table

DEGREE = math.pi / 180
BEYOND = 7.0  # rad; headings in radians are seldom so large
FEW = 5  # steps that are named; of more only their number is told


@dataclass(frozen=True)
class Results:
    """The beliefs of a file by the index of the entry, in m and rad, and what was made of it."""

    file: str
    rows: Mapping[int, Row]
    remarks: tuple[str, ...]


def results(table: Table, given: Sequence[int], expected: Mapping[int, Gaussian]) -> Results:
    """The results in a table.

    given : the indices of the moves and beams of the run
    expected : what the reference believes after each of them, by which units are recognised

    Raises UsageError where the rows are not those of the run.
    """
    rows, remarks = _aligned(table, given)
    known = [index for index in rows if index in expected]
    known = [index for index in known if np.isfinite(rows[index].x[2])]
    θ = np.array([rows[index].x[2] for index in known])
    right = np.array([expected[index].mean[2] for index in known])
    unit = table.unit or _nearer(θ, right)
    remarks.append(f"{table.file}: headings are read as {unit}")
    factor = DEGREE if unit == "degrees" else 1.0
    spread = _spread_factor([(rows[i].P[2, 2], expected[i].covariance[2, 2]) for i in known])
    if spread != 1.0:
        remarks.append(f"{table.file}: P is read as of m and degrees")
    missing = [index for index in given if index not in rows]
    if missing:
        remarks.append(f"{table.file}: no row of {steps_named(missing)}: not compared, nor is what "
                       "follows each of them")  # fmt: skip
    return Results(
        table.file, {i: _scaled(row, factor, spread) for i, row in rows.items()}, tuple(remarks)
    )


def steps_named(indices: Sequence[int]) -> str:
    """Some steps in words.

    >>> steps_named([3]), steps_named([3, 4, 9])
    ('step 3', 'steps 3, 4 and 9')
    """
    if len(indices) == 1:
        return f"step {indices[0]}"
    if len(indices) > FEW:
        return f"{len(indices)} steps, the first of them step {indices[0]}"
    return f"steps {', '.join(map(str, indices[:-1]))} and {indices[-1]}"


def _aligned(table: Table, given: Sequence[int]) -> tuple[dict[int, Row], list[str]]:
    """Each row under the index of its entry; 0 is the start."""
    if not table.numbered:
        shift = {len(given): 0, len(given) + 1: -1}.get(len(table.rows))
        if shift is None:
            raise UsageError(
                f"{table.file}: {_count(table.rows)} and no column 'index', where the run has "
                f"{len(given)} moves and beams; name the step of each row"
            )
        return _by_order({i + 1 + shift: row for i, row in table.rows.items()}, given), []
    indices = {*table.rows} - {0}
    if indices <= {*given}:
        return dict(table.rows), []
    if indices > {*given}:  # a row of each command, texts as well, as --csv of `run` has them
        return {i: row for i, row in table.rows.items() if i == 0 or i in {*given}}, []
    if indices == {*range(1, len(indices) + 1)} and len(indices) <= len(given):
        told = f"{table.file}: its index counts the moves and beams: row 1 is of step {given[0]}"
        return _by_order(table.rows, given), [told]
    odd = min(indices - {*given})
    right = f"those of the run are {', '.join(map(str, given[:FEW]))}{', …' * (len(given) > FEW)}"
    line = table.rows[odd].line
    raise UsageError(f"{table.file}:{line}:1: index: {odd} is no move or beam; {right}")


def _by_order(rows: Mapping[int, Row], given: Sequence[int]) -> dict[int, Row]:
    return {0 if order == 0 else given[order - 1]: row for order, row in rows.items()}


def _count(rows: Mapping[int, Row]) -> str:
    return "1 row" if len(rows) == 1 else f"{len(rows)} rows"


def _nearer(θ: Array, right: Array) -> str:
    """In which unit headings are nearer to the right ones; degrees, where both are alike, or where
    they go beyond a full turn in radians.
    """
    if not len(θ):
        return "degrees"
    in_degrees, in_radians = (
        float(np.median(np.abs(wrap(θ * factor - right)))) for factor in (DEGREE, 1.0)
    )
    surely = 1.0 if np.abs(θ).max() <= BEYOND else 0.1
    return "radians" if in_radians < surely * in_degrees else "degrees"


def _spread_factor(pairs: Iterable[tuple[float, float]]) -> float:
    """By which entries of P of the heading are multiplied: 1, or a degree where its variance is
    some thousand times too large.
    """
    sizes = [math.log(theirs / right) for theirs, right in pairs if theirs > 0 and right > 0]
    of_degrees = -2 * math.log(DEGREE)
    near = bool(sizes) and abs(np.median(sizes) - of_degrees) < of_degrees / 4
    return DEGREE if near else 1.0


def _scaled(row: Row, factor: float, spread: float) -> Row:
    """A row in m and rad."""
    scale, scales = np.array([1.0, 1.0, factor]), np.array([1.0, 1.0, spread])
    both = np.outer(scales, scales)
    halves = Halves(row.halves.x * scale, row.halves.P * both)
    return replace(row, x=row.x * scale, P=row.P * both, halves=halves)
