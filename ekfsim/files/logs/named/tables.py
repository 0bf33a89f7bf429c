"""A table whose columns have names → its numbers, in s, m and rad."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.keys.recorded.columns import UNITS, TableKeys
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.named.head import ALSO, meant
from ekfsim.files.logs.table import Rows, Wanted
from ekfsim.files.logs.tables.angles import BEYOND_A_TURN
from ekfsim.files.logs.tables.declared import Column
from ekfsim.files.logs.tables.layout import Layout, plain
from ekfsim.files.logs.tables.reading import in_units
from ekfsim.files.logs.text import Lines
from ekfsim.files.yaml.telling import quoted
from ekfsim.geometry import Array

# what columns are in, and beyond which number of rad they are degrees, where nobody says
ANGLES = {
    "omega": 10.0,
    "turn": np.pi,
    "turn_before": np.pi,
    "yaw": np.inf,
    "theta": np.inf,
    "bearing": BEYOND_A_TURN,
    "azimuth": BEYOND_A_TURN,
    "elevation": np.pi,
    "sigma_bearing": np.inf,
}
LARGEST = {"t": 1e12, "x": 1e8, "y": 1e8}  # beyond which a number cannot be meant
SQUARED = "variance"  # how the names of columns begin whose unit is a square
NOTHING = ("", "inf", "+inf", "-inf")  # is no number, and no mistake where a field may be empty


class Source(NamedTuple):
    """Where a table is, and what the commands file says of it."""

    path: Path
    keys: TableKeys
    recording: RecordingKeys
    lines: Lines | None = None  # of one that stands in no file of its own

    def columns(self) -> dict[str, str | int]:
        """Where it says that this table's columns stand."""
        told = self.keys.columns
        return {} if told is None else told.model_dump(exclude_unset=True)

    def shared(self) -> dict[str, str | int]:
        """Where it says that columns stand in any of the log's tables that has them."""
        told = self.recording.columns
        return {} if told is None else told.model_dump(exclude_unset=True)

    def units(self) -> dict[str, str | float]:
        """What is said of units, for this table or for all."""
        told = dict[str, str | float]()
        if self.recording.time_unit is not None:
            told["t"] = self.recording.time_unit
        if self.recording.angle_unit is not None:
            told.update(dict.fromkeys(ANGLES, self.recording.angle_unit))
        for keys in self.recording.units, self.keys.units:
            told.update({} if keys is None else keys.model_dump(exclude_unset=True))
        return told


@dataclass(frozen=True)
class Table:
    """The rows of a table, and where each of its columns stands."""

    lines: Lines  # without the first, where that has the names
    separator: str | None
    width: int  # how many columns a row has
    places: Mapping[str, int]  # of each column by its name, from 0
    units: Mapping[str, str | float]  # of the columns that tell theirs
    shared: frozenset[str] = frozenset()  # names that were told for all tables, and found here
    told: frozenset[str] = frozenset()  # names whose places the commands file tells for this table
    remarks: tuple[str, ...] = ()  # what is to be said when its rows are read

    @property
    def file(self) -> str:
        """How messages name it."""
        return self.lines.file

    def known_as(self, name: str) -> str | None:
        """The name by which a column stands here, None where there is no such column."""
        names = (name, *ALSO.get(name, ()), *meant(name))
        return next((one for one in names if one in self.places), None)

    def has(self, *names: str) -> bool:
        """Whether it has all of these columns."""
        return all(self.known_as(name) is not None for name in names)

    def unit_of(self, name: str) -> str | float | None:
        """What a column is in, or how many s, m, rad, … one is, where that is told."""
        return self.units.get(name, self.units.get(self.known_as(name) or ""))

    def rows(
        self,
        names: Iterable[str],
        asked: Asked,
        motion: Rows | None = None,
        maybe: frozenset[str] = frozenset(),
        ranges: frozenset[str] = frozenset(),
    ) -> Rows:
        """The numbers of these columns, in s, m and rad; nan for an empty field that may be.
        `motion` is what readings and truth are to lie within.

        Raises InputError with what is wrong.
        """
        names = tuple(names)
        known = [self.known_as(name) for name in names]
        if None in known:
            missing = (n for n, k in zip(names, known, strict=True) if k is None)
            raise self.lacks(" and ".join(map(quoted, missing)))
        taken = [
            f"{quoted(k)} is taken as {n}"
            for n, k in zip(names, known, strict=True)
            if k in meant(n)
        ]
        if taken:
            asked.warnings.append(f"{self.file}: {', '.join(taken)}")
        asked.warnings.extend(self.remarks)
        places = tuple(self.places[name] for name in known if name is not None)
        return self._read(names, places, asked, motion, maybe, ranges)

    def _read(
        self,
        names: tuple[str, ...],
        places: tuple[int, ...],
        asked: Asked,
        motion: Rows | None,
        maybe: frozenset[str],
        ranges: frozenset[str],
    ) -> Rows:
        """The numbers at these places."""
        lines = self._filled([p for n, p in zip(names, places, strict=True) if n in maybe])
        width = range(self.width, self.width + 1)
        lines, separator = plain(lines, lines, places, width, asked.warnings)
        factors = np.array([self._factor(name) for name in names])
        columns = [
            Column(name, self._natural(name), "", most=ANGLES.get(name, np.inf)) for name in names
        ]
        largest = [LARGEST.get(name, 1e6) for name in names]
        wanted = Wanted(
            names, places, width, maybe, ranges, tuple((np.array(largest) / factors).tolist())
        )
        unit = self.unit_of("t")
        units = {"t": unit} if isinstance(unit, str) else {}
        read = in_units(Layout(lines, wanted, separator, units), columns, asked, motion)
        return replace(read.rows, values=_scaled(read.rows.values, factors))

    def words(self, name: str, rows: Rows) -> list[str]:
        """What stands in a column of words, for each of some rows."""
        place = self.places[self.known_as(name) or ""]
        texts = dict(zip(self.lines.numbers, self.lines.texts, strict=True))
        return [
            texts[line].split(self.separator)[place].strip().strip('"')
            for line in rows.lines.tolist()
        ]

    def all_words(self, name: str) -> list[str]:
        """What stands in a column of words, in every line."""
        place = self.places[self.known_as(name) or ""]
        rows = (text.split(self.separator) for text in self.lines.texts)
        return [row[place].strip() for row in rows if place < len(row)]

    def holds(self, columns: Iterable[str], name: str, word: str) -> bool:
        """Whether anything stands in all of some columns, in a line with this word in another."""
        places = [self.places[self.known_as(column) or ""] for column in columns]
        words = self.all_words(name)
        rows = (text.split(self.separator) for text in self.lines.texts)
        return any(
            word == own and all(row[place].strip() not in ("", "nan") for place in places)
            for own, row in zip(words, rows, strict=False)
            if len(row) == self.width
        )

    def lacks(self, what: str, right: str = "") -> InputError:
        """The mistake that a column is not there."""
        found = f"found {', '.join(map(quoted, self.places))}"
        line = max(1, min(self.lines.numbers, default=2) - 1)
        wrong = f"no column is named {what}"
        told = f"{right}; {found}" if right else found
        return InputError([Mistake(Place(self.file, line, 1), "", wrong, told)])

    def _natural(self, name: str) -> str:
        """The unit in which a column is looked at, to find what it is in: none where that is
        told, and so is no guess.
        """
        unit = self.unit_of(name)
        if name == "t":
            return "s" if unit is None or isinstance(unit, str) else ""
        return "rad" if name in ANGLES and unit is None else ""

    def _factor(self, name: str) -> float:
        """How many s, m, rad, … one of a column is; of a variance, by what it is the square of. The
        words of time are left to who reads stamps by their digits.
        """
        unit = self.unit_of(name)
        if unit is None and name.startswith(SQUARED):
            own = name.removeprefix(SQUARED).removeprefix("_")
            return self._factor(own) ** 2 if own else 1.0
        if unit is None or (name == "t" and isinstance(unit, str)):
            return 1.0
        return UNITS[unit] if isinstance(unit, str) else unit

    def _filled(self, places: list[int]) -> Lines:
        """The lines with nan where nothing stands that could be read, or inf: no echo."""
        mark = self.separator
        if not places or mark is None:
            return self.lines
        texts = []
        for text in self.lines.texts:
            fields = text.split(mark)
            for place in places:
                if place < len(fields) and fields[place].strip().lower() in NOTHING:
                    fields[place] = "nan"
            texts.append(mark.join(fields))
        return replace(self.lines, texts=texts)


def _scaled(values: Array, factors: Array) -> Array:
    """Numbers in s, m, rad, …; parts of ten are divided by, which rounds once. values : (n, k)"""
    if (factors == 1).all():
        return values
    parts = [
        column / round(1 / one) if one < 1 and (1 / one).is_integer() else column * one
        for column, one in zip(values.T, factors.tolist(), strict=True)
    ]
    return np.column_stack(parts)
