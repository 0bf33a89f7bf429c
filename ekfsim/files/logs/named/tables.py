"""A table whose columns have names: in its first line, or by their numbers."""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.header import separator_of
from ekfsim.files.logs.table import Rows, Wanted, numbers_of
from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.geometry import Array

# how else a column may be called
ALSO = {
    "t": ("time", "timestamp", "stamp"),
    "v": ("speed",),
    "omega": ("turn_rate", "yaw_rate"),
    "left": ("vl", "v_left", "left_wheel"),
    "right": ("vr", "v_right", "right_wheel"),
    "turn": ("dheading", "dtheta"),
    "theta": ("heading", "phi", "orientation"),
    "id": ("landmark", "node", "marker", "subject"),
    "target": ("landmark", "node", "marker", "id", "beam", "pair"),
}
UNITS = {  # s, m, m/s, rad, … that one of each is
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9,
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "m/s": 1.0, "km/h": 1 / 3.6, "m/s²": 1.0, "m/s^2": 1.0,
    "rad": 1.0, "deg": math.pi / 180, "rad/s": 1.0, "deg/s": math.pi / 180, "v": 1.0,
}  # fmt: skip
STATED = re.compile(r"(?P<name>.+?)[ _]*(?:\[(?P<a>[^]]+)\]|\((?P<b>[^)]+)\)|_(?P<c>[^_ ]+))")


@dataclass(frozen=True)
class Scaled(Wanted):
    """Columns in units of their own."""

    units: tuple[float, ...] = ()

    def limits(self) -> Array:
        """The magnitude beyond which a number cannot be meant."""
        return super().limits() / self.units


@dataclass(frozen=True)
class Table:
    """The rows of a table, and where each of its columns stands."""

    lines: Lines  # without the first, where that has the names
    separator: str | None
    width: int  # how many columns a row has
    places: Mapping[str, int]  # of each column by its name, from 0
    units: Mapping[str, str]  # of the columns that state one

    @property
    def file(self) -> str:
        """How messages name it."""
        return self.lines.file

    def place_of(self, name: str) -> int | None:
        """Where a column stands, which may go by other names, too."""
        for known in (name, *ALSO.get(name, ())):
            if known in self.places:
                return self.places[known]
        return None

    def has(self, *names: str) -> bool:
        """Whether it has all of these columns."""
        return all(self.place_of(name) is not None for name in names)

    def unit_of(self, name: str) -> str | None:
        """The unit that a column states."""
        for known in (name, *ALSO.get(name, ())):
            if known in self.places:
                return self.units.get(known)
        return None

    def rows(
        self,
        names: Iterable[str],
        warnings: list[str],
        maybe: frozenset[str] = frozenset(),
        ranges: frozenset[str] = frozenset(),
    ) -> Rows:
        """The numbers of these columns, in s, m and rad. Raises InputError with what is wrong."""
        names = tuple(names)
        places = [self.place_of(name) for name in names]
        if None in places:
            lacking = [name for name, place in zip(names, places, strict=True) if place is None]
            raise self.lacks(", ".join(map(repr, lacking)))
        units = tuple(UNITS.get(self.unit_of(name) or "", 1.0) for name in names)
        wanted = Scaled(
            names,
            tuple(place for place in places if place is not None),
            range(self.width, self.width + 1),
            maybe,
            ranges,
            units=units,
        )
        rows = numbers_of(self.lines, wanted, self.separator, warnings)
        return replace(rows, values=rows.values * units) if set(units) != {1.0} else rows

    def words(self, name: str, rows: Rows) -> list[str]:
        """What stands in a column of words, for each of some rows."""
        place = self.place_of(name)
        assert place is not None
        texts = dict(zip(self.lines.numbers, self.lines.texts, strict=True))
        return [
            texts[line].split(self.separator)[place].strip().strip('"')
            for line in rows.lines.tolist()
        ]

    def lacks(self, what: str, right: str = "") -> InputError:
        """The mistake that a column is not there."""
        found = f"found {', '.join(map(repr, self.places))}"
        place = Place(self.file, max(1, min(self.lines.numbers, default=2) - 1), 1)
        wrong = f"no column is named {what}"
        return InputError([Mistake(place, "", wrong, f"{right}; {found}" if right else found)])


def named(path: Path, wanted: str) -> Table:
    """A table whose first line names its columns; `wanted` is an example of such a line.

    Raises UsageError where there is no such file, InputError where it names none.
    """
    lines = lines_of(path)
    if not len(lines):
        place = Place(lines.file, 1, 1)
        raise InputError(
            [Mistake(place, "", "the file is empty", f"it begins with the line {wanted}")]
        )
    line, separator = lines.texts[0], separator_of(lines.texts[0])
    fields = [field.strip().strip('"') for field in line.split(separator)]
    if fields[-1] == "":
        fields.pop()
    if not any(field[:1].isalpha() for field in fields):
        place = Place(lines.file, lines.numbers[0], 1)
        right = f"the first line says what they are: {wanted}"
        raise InputError([Mistake(place, "", f"{line!r} names no columns", right)])
    places, units = dict[str, int](), dict[str, str]()
    for place_of, field in enumerate(fields):
        name, unit = stated(field.lower())
        if name in places:
            place = Place(lines.file, lines.numbers[0], 1)
            wrong = f"two columns are named {name!r}"
            raise InputError([Mistake(place, "", wrong, "give one another name")])
        places[name] = place_of
        if unit:
            units[name] = unit
    body = replace(lines[1:], ended=lines.ended or len(lines) == 1)
    return Table(body, separator, len(fields), places, units)


def stated(field: str) -> tuple[str, str | None]:
    """The name of a column, and the unit that stands with it.

    >>> stated("t_ms"), stated("bearing [deg]"), stated("sigma_x")
    (('t', 'ms'), ('bearing', 'deg'), ('sigma_x', None))
    """
    if found := STATED.fullmatch(field):
        unit = found["a"] or found["b"] or found["c"]
        if unit in UNITS:
            return found["name"], unit
    return field, None
