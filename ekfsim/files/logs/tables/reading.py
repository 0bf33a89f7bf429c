"""A file of a log → Rows, in s, m and rad."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ekfsim.files.keys.recorded.columns import UNITS
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.table import Rows, sane, values_of, whole
from ekfsim.files.logs.tables.angles import ANGLES, DEGREE, are_degrees, are_degrees_of_course
from ekfsim.files.logs.tables.declared import Column, Table
from ekfsim.files.logs.tables.layout import Layout, layout_of
from ekfsim.files.logs.tables.stamps import (
    SPOKEN,
    seconds_of,
    unit_beside,
    unit_of_motion,
    usual_step,
)
from ekfsim.files.logs.text import lines_of
from ekfsim.geometry import Array

# of the lengths and speeds that a first line may tell
TOLD = {"m": ("m", "cm", "mm", "km"), "m/s": ("m/s", "cm/s", "mm/s", "km/h")}


class Read(NamedTuple):
    """The rows of a file that can be used, and how they were written."""

    rows: Rows
    layout: Layout

    def texts(self, name: str) -> list[str]:
        """A column as it stands, a text for each row."""
        place = self.layout.wanted.places[self.layout.wanted.names.index(name)]
        numbered = dict(zip(self.layout.lines.numbers, self.layout.lines.texts, strict=True))
        separator = self.layout.separator
        return [numbered[line].split(separator)[place] for line in self.rows.lines.tolist()]

    def column(self, line: int, name: str) -> int:
        """Where a column begins in a line, from 1."""
        lines, separator = self.layout.lines, self.layout.separator
        place = self.layout.wanted.places[self.layout.wanted.names.index(name)]
        text = lines.texts[lines.numbers.index(line)]
        before = text.split(separator)[:place]
        return sum(len(field) + 1 for field in before) + 1


def read_table(path: Path, table: Table, asked: Asked, motion: Rows | None = None) -> Rows:
    """The columns that a table declares, in its order and in s, m and rad, of all rows that can be
    used. `motion` is what readings and truth are to lie within.

    Raises UsageError where there is no such file, InputError with what is wrong in it.
    """
    return read_text(path, table, asked, motion).rows


def read_text(path: Path, table: Table, asked: Asked, motion: Rows | None = None) -> Read:
    """The same, and the text of the rows."""
    return in_units(layout_of(lines_of(path), table, asked.warnings), table.columns, asked, motion)


def in_units(
    layout: Layout, columns: Sequence[Column], asked: Asked, motion: Rows | None = None
) -> Read:
    """The rows of a file that is written so, in s, m and rad.

    Raises InputError with what is wrong in it.
    """
    layout = layout._replace(lines=whole(layout.lines, layout.separator, asked.warnings))
    values = values_of(layout.lines, layout.wanted, layout.separator)
    for n, column in enumerate(columns):
        if column.unit == "s":
            values[:, n] = _seconds(layout, n, values[:, n], asked, motion)
        elif column.unit in ANGLES:
            step = usual_step(values[:, 0]) if columns[0].unit == "s" else 0.0
            values[:, n] *= _angle(layout, column, values[:, n], asked, step)
        elif (unit := layout.units.get(column.name, "")) in TOLD.get(column.unit, ()):
            values[:, n] *= UNITS[unit]
    _turn_headings(layout, columns, values, asked)
    rows = Rows(layout.lines.file, np.array(layout.lines.numbers, np.int64), values)
    return Read(sane(rows, layout.wanted, asked.warnings), layout)


def _seconds(layout: Layout, n: int, t: Array, asked: Asked, motion: Rows | None) -> Array:
    """The stamps in s, whatever they are in; told where nobody said so. t : (n,) as they stand"""
    told, why = asked.recording.time_unit or layout.units.get(layout.wanted.names[n]), ""
    if told is None and motion is None:
        told, why = unit_of_motion(t, 1 / asked.world.believed_robot.rate)
    elif told is None and motion is not None:
        told, why = unit_beside(t, motion.t)
    if why and told is not None:
        cure = "say otherwise with --set recording.timeUnit=s"
        asked.warnings.append(
            f"{layout.lines.file}: {layout.wanted.names[n]} is taken as {SPOKEN[told]}: {why}; "
            f"{cure}"
        )
    if told in (None, "s"):
        return t
    place, separator = layout.wanted.places[n], layout.separator
    return seconds_of([text.split(separator)[place] for text in layout.lines.texts], str(told))


def _angle(layout: Layout, column: Column, values: Array, asked: Asked, step: float) -> float:
    """What a column's angles are multiplied with to be radians (a yaw in degrees stays so).
    step : s between two rows, by which turns since the row before are judged
    """
    unit = asked.recording.angle_unit or layout.units.get(column.name)
    judged = values / step if column.per_row and step else values
    if unit is None and are_degrees(judged, column):
        _tell_degrees(layout, column, asked, "more than can be meant")
        unit = "degrees"
    return 1.0 if unit is None else ANGLES[unit] / ANGLES[column.unit]


def _turn_headings(layout: Layout, columns: Sequence[Column], values: Array, asked: Asked) -> None:
    """Make headings radians that lead along the way of their poses as degrees alone."""
    places = {column.name: n for n, column in enumerate(columns)}
    if asked.recording.angle_unit is not None or not {"x", "y"} <= places.keys():
        return
    x, y = values[:, places["x"]], values[:, places["y"]]
    for column in columns:
        n = places[column.name]
        if column.unit != "rad" or column.name in layout.units:
            continue
        if are_degrees_of_course(x, y, values[:, n]):
            _tell_degrees(layout, column, asked, "not along the way of the poses")
            values[:, n] *= DEGREE


def _tell_degrees(layout: Layout, column: Column, asked: Asked, why: str) -> None:
    told = f"{column.name} is taken as degrees: as radians it would be {why}"
    cure = "say otherwise with --set recording.angleUnit=radians"
    asked.warnings.append(f"{layout.lines.file}: {told}; {cure}")
