"""Lines → numbers: quickly where all is well, and line by line where something is wrong.

What no person would use is left out, and told: a last line that was cut short, numbers that are
none (nan, inf), or cannot be meant (denormals, a million metres, a range of 0 or less). Whatever
else is wrong is refused with its place.
"""

import math
import re
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.files.source import mistake
from ekfsim.files.yaml.telling import quoted
from ekfsim.geometry import Array, Booleans, Integers

NUMBER = re.compile(
    r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?(nan|inf|infinity)", re.IGNORECASE | re.ASCII
)
TINY = 1e-50  # no sensor tells less; denormals and their like are memory that nobody wrote
MOST_TOLD = 20  # mistakes
MOST_WARNED = 3  # rows of one kind
EPOCH = 1e10  # s since 1970, until the year 2286; stamps count from then on in
FINER = (("milliseconds", "ms", 1e3), ("microseconds", "us", 1e6), ("nanoseconds", "ns", 1e9))
# s and m: until the year 33658, and for any map grid
ENORMOUS = {"t": 1e12, "time": 1e12, "x": 1e8, "y": 1e8}


@dataclass(frozen=True)
class Wanted:
    """The columns of a table that are read:
    how messages call them, and where they stand, from 0.
    """

    names: tuple[str, ...]
    places: tuple[int, ...]
    widths: range  # how many columns a row may have
    maybe: frozenset[str] = frozenset()  # columns that may say nan
    # columns that are ranges: where nothing answers, many sensors say 0 or −1
    ranges: frozenset[str] = frozenset()
    largest: tuple[float, ...] = ()  # the magnitude of each beyond which it cannot be meant
    told: str = ""  # what columns the file is to have, as a refusal says it

    def limits(self) -> Array:
        """The magnitude beyond which a number cannot be meant."""
        return np.array(self.largest or [ENORMOUS.get(name, 1e6) for name in self.names])


@dataclass(frozen=True)
class Rows:
    """The numbers of a table, and the line that each row comes from."""

    file: str
    lines: Integers  # (n,)
    values: Array  # (n, k), a column for each that was wanted
    left_out: int = 0  # rows whose numbers cannot be meant
    why: str = ""  # the first of them is left out

    def __len__(self) -> int:
        return len(self.lines)

    def __getitem__(self, part: Booleans | Integers | slice) -> "Rows":
        return replace(self, lines=self.lines[part], values=self.values[part])

    @property
    def t(self) -> Array:
        """The first column, the time in s : (n,)"""
        return self.values[:, 0]

    def at(self, row: int) -> str:
        """How warnings name a row."""
        return f"{self.file}:{self.lines[row]}"


def bare_table(path: Path, wanted: Wanted, warnings: list[str]) -> Rows:
    """A table without a header.

    Raises UsageError where there is no such file, InputError with what is wrong in it.
    """
    return numbers_of(lines_of(path), wanted, None, warnings)


def numbers_of(lines: Lines, wanted: Wanted, separator: str | None, warnings: list[str]) -> Rows:
    """The wanted columns of all rows that can be used.
    Raises InputError with the mistakes in the others.
    """
    lines = whole(lines, separator, warnings)
    values = values_of(lines, wanted, separator)
    return sane(Rows(lines.file, np.array(lines.numbers, np.int64), values), wanted, warnings)


def values_of(lines: Lines, wanted: Wanted, separator: str | None) -> Array:
    """The wanted columns of all rows, as they stand : (n, k)
    Raises InputError with the mistakes in them.
    """
    values = _quickly(lines, wanted, separator)
    return _carefully(lines, wanted, separator) if values is None else values


def whole(lines: Lines, separator: str | None, warnings: list[str]) -> Lines:
    """The lines without what stands after their last column, and without a last line that was cut
    short.
    """
    if separator:
        lines = replace(
            lines, texts=[text.rstrip().removesuffix(separator) for text in lines.texts]
        )
    if not len(lines):
        return lines
    last = lines.texts[-1].split(separator)
    above = [text.split(separator) for text in lines.texts[-20:-1]]
    place = f"{lines.file}:{lines.numbers[-1]}"
    if above and len(last) < len(above[-1]):
        why = "in the middle of a row"
    elif (
        above
        and not lines.ended
        and (not is_number(last[-1]) or _is_cut(last[-1], [row[-1] for row in above]))
    ):
        why = "in the middle of a number"
    else:
        if not lines.ended:
            warnings.append(
                f"{place}: the file ends without a line break; its last number may be cut short"
            )
        return lines
    warnings.append(f"{place}: the file ends {why}: this line is left out")
    return replace(lines[:-1], ended=True)


def _is_cut(number: str, above: list[str]) -> bool:
    """Whether a number has fewer decimals than the others, which all have the same."""
    decimals = {len(text.strip().partition(".")[2]) for text in above}
    return (
        len(above) > 2
        and len(decimals) == 1
        and len(number.strip().partition(".")[2]) < decimals.pop()
    )


def is_number(text: str) -> bool:
    """Whether a text is a number as programs write it, nan and inf included."""
    return NUMBER.fullmatch(text.strip()) is not None


def _quickly(lines: Lines, wanted: Wanted, separator: str | None) -> Array | None:
    """The wanted columns as numpy reads them;
    None where it stumbles, or some rows have other widths.
    """
    if not len(lines):
        return np.empty((0, len(wanted.places)))
    width, *others = {_width(text, separator) for text in lines.texts}
    if others or width not in wanted.widths:
        return None
    try:
        return np.loadtxt(
            lines.texts, delimiter=separator, usecols=wanted.places, ndmin=2, comments=None
        )
    except (ValueError, OverflowError):
        return None


def _width(text: str, separator: str | None) -> int:
    return text.count(separator) + 1 if separator else len(text.split())


def _carefully(lines: Lines, wanted: Wanted, separator: str | None) -> Array:
    """The same in as long as it takes. Raises InputError with the mistakes, each at its place."""
    mistakes, rows, more = list[Mistake](), list[list[float]](), 0
    widths = [_width(text, separator) for text in lines.texts]
    usual = next((width for width in widths if width in wanted.widths), None)
    if usual is None and len(set(widths)) == 1:
        raise InputError([_width_mistake(lines, 0, widths[0], wanted)])
    for row, text in enumerate(lines.texts):
        found = _row_mistakes(lines, row, text, separator, wanted, usual)
        mistakes, more = (
            (mistakes + found, more) if len(mistakes) < MOST_TOLD else (mistakes, more + len(found))
        )
        if not mistakes:
            fields = text.split(separator)
            rows.append([float(fields[place]) for place in wanted.places])
    if more:
        place = Place(lines.file, mistakes[-1].place.line, 1)
        mistakes.append(Mistake(place, "", f"and {more} more mistakes below"))
    if mistakes:
        raise InputError(mistakes)
    return np.array(rows).reshape(len(rows), len(wanted.places))


def _row_mistakes(
    lines: Lines, row: int, text: str, separator: str | None, wanted: Wanted, usual: int | None
) -> list[Mistake]:
    """What is wrong with one row."""
    fields = text.split(separator)
    if len(fields) not in wanted.widths or (usual is not None and len(fields) != usual):
        only = wanted if usual is None else replace(wanted, widths=range(usual, usual + 1))
        return [_width_mistake(lines, row, len(fields), only)]
    found, column = [], 0
    for place, field in enumerate(fields):
        column = text.index(field, column) if field else column
        if place in wanted.places and not is_number(field):
            start = column + len(field) - len(field.lstrip())
            name = wanted.names[wanted.places.index(place)]
            wrong = (
                f"{quoted(field)} is not a number"
                if field.strip()
                else "nothing stands where a number belongs"
            )
            meant = field.strip().strip("\"'").replace(",", ".")  # as spreadsheets write it
            right = f"write {meant}" if NUMBER.fullmatch(meant) else "write e.g. 1.5"
            found.append(
                Mistake(Place(lines.file, lines.numbers[row], start + 1), name, wrong, right)
            )
        column += len(field) + (separator is not None)
    return found


def _width_mistake(lines: Lines, row: int, width: int, wanted: Wanted) -> Mistake:
    """That a row has too few or too many columns."""
    columns = "1 column stands" if width == 1 else f"{width} columns stand"
    widths = wanted.widths
    right = f"it must have {widths.start}" + (
        " or more" if len(widths) > 2 else f" or {widths[-1]}" if len(widths) == 2 else ""
    )
    if width == 2 * widths.start and len(widths) == 1:
        right += "; if these are decimal commas, write points, or ; between the columns"
    if row == 0 and wanted.told:
        right += f"; {wanted.told}"
    return Mistake(Place(lines.file, lines.numbers[row], 1), "", f"{columns} in this row", right)


def sane(rows: Rows, wanted: Wanted, warnings: list[str]) -> Rows:
    """The rows whose numbers can be meant."""
    size = np.abs(rows.values)
    allowed = np.isnan(rows.values) & np.array([name in wanted.maybe for name in wanted.names])
    odd = ~allowed & (~(size <= wanted.limits()) | ((size > 0) & (size < TINY)))
    odd |= (rows.values <= 0) & np.array([name in wanted.ranges for name in wanted.names])
    bad = np.flatnonzero(odd.any(axis=1))
    whys = list[str]()
    for row in bad[:MOST_WARNED]:
        column = int(np.argmax(odd[row]))
        value = float(rows.values[row, column])
        name = wanted.names[column]
        whys.append(f"{name}: {value:g} is {_why(value, name, name in wanted.ranges)}")
        warnings.append(f"{rows.at(row)}: {whys[-1]}: this row is left out")
    if len(bad) > MOST_WARNED:
        warnings.append(
            f"{rows.at(bad[MOST_WARNED])}: so {_are_rows(len(bad) - MOST_WARNED)} from here on"
        )
    return replace(rows[~odd.any(axis=1)], left_out=len(bad), why=whys[0]) if whys else rows


def _why(value: float, name: str, is_range: bool) -> str:
    """Why a number cannot be meant."""
    if not math.isfinite(value):
        return "no number"
    if 0 < abs(value) < TINY:
        return "a denormal" if abs(value) < sys.float_info.min else "next to nothing"
    if name in ("t", "time"):
        finer = (
            f" (if these are {unit}: --set recording.timeUnit={short})"
            for unit, short, second in FINER
            if abs(value) < EPOCH * second
        )
        return f"no time in s{next(finer, '')}"
    return "no range" if is_range and value <= 0 else "absurdly large"


def _are_rows(count: int) -> str:
    return "is 1 more row" if count == 1 else f"are {count} more rows"


def some(rows: Rows, what: str) -> Rows:
    """The rows, of which there must be one. Raises InputError where there is none."""
    if not len(rows):
        left_out = f"all {rows.left_out} rows are left out: {rows.why}"
        wrong = left_out if rows.left_out else "the file holds no rows"
        raise mistake(rows.file, 1, 1, wrong, f"without {what} there is nothing to localize")
    return rows
