"""A table whose columns have names → its numbers, in s, m and rad."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.keys.columns import UNITS, TableKeys
from ekfsim.files.keys.recording import RecordingKeys
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.header import separator_of
from ekfsim.files.logs.named.head import (
    ALSO,
    absent,
    fields_of,
    meant,
    names_in,
    place_of,
    placed,
    stated,
)
from ekfsim.files.logs.table import Rows, Wanted
from ekfsim.files.logs.tables.angles import BEYOND_A_TURN
from ekfsim.files.logs.tables.declared import Column
from ekfsim.files.logs.tables.layout import Layout, plain, unquoted
from ekfsim.files.logs.tables.reading import in_units
from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.files.yaml.telling import quoted
from ekfsim.geometry import Array

# what columns are in, and beyond which number of rad they are degrees, where nobody says
ANGLES = {
    "omega": 10.0,
    "turn": np.pi,
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
MANY = 8  # kinds of rows that are listed


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


def opened(source: Source, wanted: str) -> Table:
    """A table whose columns are found by the names of its first line, or as the commands file says;
    `wanted` is an example of such a line.

    Raises UsageError where there is no such file, InputError where it lacks a column that is told.
    """
    lines = source.lines or lines_of(source.path)
    lines = replace(lines, texts=[unquoted(text) for text in lines.texts])
    if source.keys.rows is not None:
        lines = _of_kind(lines, source.keys.rows)
    if not len(lines):
        right = f"it begins with the line {wanted}"
        raise InputError([Mistake(Place(lines.file, 1, 1), "", "the file is empty", right)])
    separator = separator_of(lines.texts[0])
    fields = fields_of(lines.texts[0], separator)
    head = None if source.keys.rows else names_in(source.path, fields)
    body = lines
    if head == fields:
        body = replace(lines[1:], ended=lines.ended or len(lines) == 1)
    body = _ended(body, separator, len(fields))
    at = Place(lines.file, lines.numbers[0], 1)
    columns, shared = source.columns(), source.shared()
    if head is None and not columns and not shared:
        right = f"the first line says what they are: {wanted}; or recording.columns their numbers"
        wrong = f"{quoted(lines.texts[0])} names no columns"
        raise InputError([Mistake(at, "", wrong, right)])
    places, units = placed(head or [], at)
    for name, theirs in columns.items():
        place = place_of(theirs, head or [], len(fields))
        if place is None:
            raise absent(at, name, theirs, head)
        places[name] = place
    found = {n: place_of(theirs, head or [], len(fields)) for n, theirs in shared.items()}
    there = {name: place for name, place in found.items() if place is not None}
    places = {**places, **there, **{name: places[name] for name in columns}}
    units = {**units, **_stated(places, head or []), **source.units()}
    return Table(body, separator, len(fields), places, units, frozenset(there))


def _ended(lines: Lines, separator: str | None, width: int) -> Lines:
    """The lines with nan for a last field that is empty, and is no separator that ends the line."""
    if separator is None:
        return lines

    def ended(text: str) -> str:
        bare = text.rstrip()
        is_empty = bare.endswith(separator) and bare.count(separator) == width - 1
        return f"{bare}nan" if is_empty else text

    return replace(lines, texts=[ended(text) for text in lines.texts])


def _stated(places: Mapping[str, int], head: list[str]) -> dict[str, str | float]:
    """The units that a first line states of columns that go by other names here."""
    units = ((name, stated(head[place])[1]) for name, place in places.items() if place < len(head))
    return {name: unit for name, unit in units if unit is not None}


def _of_kind(lines: Lines, word: str) -> Lines:
    """The rows that begin with a word. Raises InputError where none does."""
    firsts = [text.split(separator_of(text), 1)[0].strip() for text in lines.texts]
    kept = [i for i, first in enumerate(firsts) if first == word]
    if not kept:
        kinds = list(dict.fromkeys(firsts))
        more = ", …" if len(kinds) > MANY else ""
        right = f"they begin with {', '.join(map(quoted, kinds[:MANY]))}{more}"
        wrong = f"no row begins with {quoted(word)}"
        raise InputError([Mistake(Place(lines.file, 1, 1), "", wrong, right)])
    ended = lines.ended or kept[-1] != len(lines) - 1
    numbers, texts = [lines.numbers[i] for i in kept], [lines.texts[i] for i in kept]
    return Lines(lines.file, numbers, texts, ended)
