"""A file of a log → Rows, in s, m and rad."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.table import Rows, sane, values_of, whole
from ekfsim.files.logs.tables.angles import ANGLES, DEGREE, are_degrees
from ekfsim.files.logs.tables.declared import Column, Table
from ekfsim.files.logs.tables.layout import Layout, layout_of
from ekfsim.files.logs.tables.stamps import SPOKEN, seconds_of, unit_beside, unit_of_motion
from ekfsim.files.logs.text import lines_of
from ekfsim.geometry import Array

LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0}


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
            values[:, n] *= _angle(layout, column, values[:, n], asked)
        elif column.unit == "m":
            values[:, n] *= LENGTHS.get(layout.units.get(column.name, "m"), 1.0)
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


def _angle(layout: Layout, column: Column, values: Array, asked: Asked) -> float:
    """What a column's angles are multiplied with to be radians (a yaw in degrees stays so)."""
    own = column.unit
    unit = asked.recording.angle_unit or layout.units.get(column.name)
    if unit is None and are_degrees(values, column):
        told = f"{column.name} is taken as degrees: as radians it would be beyond a turn"
        cure = "say otherwise with --set recording.angleUnit=radians"
        asked.warnings.append(f"{layout.lines.file}: {told}; {cure}")
        unit = "degrees"
    factor = 1.0 if unit is None else DEGREE if unit.startswith("degrees") else 1.0
    if unit is None:
        return 1.0
    return factor / ANGLES[own] if own.startswith("degrees") else factor
