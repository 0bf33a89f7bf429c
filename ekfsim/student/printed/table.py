"""A table of results that a program in another language wrote → the beliefs in it."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.files.source import mistake
from ekfsim.files.yaml.telling import quoted
from ekfsim.geometry import Array
from ekfsim.student.printed.columns import LIKE, Columns, columns_of
from ekfsim.student.printed.digits import NUMBER, Digits, Halves

NONE = ("nan", "inf", "1.#")  # how names begin of what is no number
LARGEST = 1e60  # of numbers; of larger ones a square or two are no numbers any more
MOST = 10**7  # steps
SEPARATORS = ";\t,"  # the first that a header has; else white space


@dataclass(frozen=True, slots=True)
class Row:
    """A belief as it is printed, and where. Its heading and P may be in degrees still."""

    line: int
    x: Array  # (3,)
    P: Array  # (3, 3)
    halves: Halves


@dataclass(frozen=True)
class Table:
    """The rows of a file by their index; where it has none, by their order, from 0."""

    file: str
    rows: Mapping[int, Row]
    numbered: bool  # whether the file has a column for the index
    unit: str  # of headings, "" where no name tells it


def table(path: Path) -> Table:
    """The table in a file. Raises UsageError where it cannot be read, InputError with what is wrong
    in it.
    """
    lines = lines_of(path)
    if not len(lines):
        raise mistake(lines.file, 1, 1, "the file is empty", f"it begins with a line like {LIKE}")
    separator = next((mark for mark in SEPARATORS if mark in lines.texts[0]), None)
    place = Place(lines.file, lines.numbers[0], 1)
    names = [field for field, _ in _fields(lines.texts[0], separator)]
    if not any(name[:1].isalpha() for name in names):
        wrong = f"{quoted(lines.texts[0])} names no columns"
        raise InputError([Mistake(place, "", wrong, f"the first line is e.g. {LIKE}")])
    columns = columns_of(names, place)
    if not isinstance(columns, Columns):
        raise InputError(columns)
    return _read(lines, len(names), separator, columns)


def _read(lines: Lines, width: int, separator: str | None, columns: Columns) -> Table:
    """The rows. Raises InputError with all that is wrong in them."""
    mistakes, texts = list[Mistake](), list[tuple[int, list[str]]]()
    for number, text in zip(lines.numbers[1:], lines.texts[1:], strict=True):
        fields = list(_fields(text, separator))
        if len(fields) != width:
            stand = "1 column stands" if len(fields) == 1 else f"{len(fields)} columns stand"
            right = f"it must have {width}, as the first line names"
            mistakes.append(
                Mistake(Place(lines.file, number, 1), "", f"{stand} in this row", right)
            )
            continue
        wanted = {*columns.x, *columns.P.values()}
        wanted |= set() if columns.index is None else {columns.index}
        for at in sorted(wanted):
            if not _is_number(fields[at][0]):
                place = Place(lines.file, number, fields[at][1])
                wrong = f"{quoted(fields[at][0])} is not a number"
                mistakes.append(Mistake(place, "", wrong, "write e.g. 0.0300499"))
        texts.append((number, [_dotted(field) for field, _ in fields]))
    if mistakes:
        raise InputError(mistakes)
    if not texts:
        raise mistake(lines.file, 1, 1, "the file holds no rows", "it has one for each step")
    return Table(lines.file, _rows(lines.file, texts, columns), columns.index is not None,
                 columns.unit)  # fmt: skip


def _rows(
    file: str, texts: Sequence[tuple[int, Sequence[str]]], columns: Columns
) -> dict[int, Row]:
    """The beliefs by index. Raises InputError where one is none, or stands twice."""
    printed = [[fields[at] for _, fields in texts] for at in columns.x]
    places = Digits.of([*printed[0], *printed[1]])
    headings = Digits.of(printed[2])
    entries = set(columns.P.values())
    spreads = Digits.of([fields[at] for _, fields in texts for at in entries])
    rows, mistakes = dict[int, Row](), list[Mistake]()
    for order, (line, fields) in enumerate(texts):
        counted = float(order) if columns.index is None else number(fields[columns.index])
        index = int(counted) if counted in range(MOST) else -1
        if index < 0 or index in rows:
            wrong = "stands twice" if index in rows else "is no whole number from 0 on"
            told = f"the index {fields[columns.index or 0]} {wrong}"
            mistakes.append(Mistake(Place(file, line, 1), "", told, "each step has one row"))
            continue
        x = np.array([number(fields[at]) for at in columns.x])
        P = np.array([[number(fields[columns.P[i, j]]) for j in range(3)] for i in range(3)])
        halves = Halves(
            np.array([places.half(x[0]), places.half(x[1]), headings.half(x[2])]),
            np.array([[spreads.half(value) for value in row] for row in P.tolist()]),
        )
        rows[index] = Row(line, x, P, halves)
    if mistakes:
        raise InputError(mistakes)
    return rows


def _fields(text: str, separator: str | None) -> Iterator[tuple[str, int]]:
    """The fields of a line without spaces and quotes around them, and the column of each, from 1.

    >>> list(_fields('1;"2,5" ; 3', ";"))
    [('1', 1), ('2,5', 3), ('3', 11)]
    """
    if separator is None:
        start = 0
        for word in text.split():
            start = text.index(word, start)
            yield word.strip('"'), start + 1
            start += len(word)
        return
    start, quotes = 0, False
    for at, letter in enumerate(f"{text.rstrip()}{separator}"):
        quotes ^= letter == '"'
        if letter == separator and not quotes:
            field = text.rstrip()[start:at]
            yield field.strip().strip('"').strip(), start + len(field) - len(field.lstrip()) + 1
            start = at + 1


def _dotted(text: str) -> str:
    """A number with a point, as it was, or with a decimal comma."""
    return text.replace(",", ".").replace("−", "-")


def _is_number(text: str) -> bool:
    """Whether a text is a number, or what programs print where none came out."""
    text = _dotted(text)
    digits = any(letter.isdigit() for letter in text)
    return text.lower().strip("-+()").startswith(NONE) or (
        digits and NUMBER.fullmatch(text) is not None
    )


def number(text: str) -> float:
    """A number as any language prints it; nan where it is none, or larger than any.

    >>> number("1.5D-3"), number("-nan(ind)")
    (0.0015, nan)
    """
    if NUMBER.fullmatch(text) is None:
        return math.nan
    value = float(text.lower().replace("d", "e"))
    return value if abs(value) <= LARGEST else math.nan
