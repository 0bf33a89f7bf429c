"""How the rows of a file are written: what stands between the columns, a first line of names or
none, decimal commas, quotes.
"""

import difflib
from dataclasses import replace
from typing import NamedTuple

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.header import separator_of
from ekfsim.files.logs.table import Wanted, is_number
from ekfsim.files.logs.tables.declared import SCHEMA, Column, Table
from ekfsim.files.logs.tables.names import OTHERS, Named, named
from ekfsim.files.logs.text import Lines
from ekfsim.files.source import mistake
from ekfsim.files.yaml.telling import quoted

SAMPLE = 20  # rows by which a file is judged
# what stands between columns (None: white space), and whether numbers have decimal commas
TAB = "\t"
WAYS = (
    *((",", False), (";", False), (None, False), (TAB, False)),
    *((";", True), (TAB, True), (None, True)),
)
BLANK = str.maketrans(",", " ")
POINT = str.maketrans(",", ".")


class Layout(NamedTuple):
    """Rows that numpy reads, and what their columns are."""

    lines: Lines  # without the first, where that holds names
    wanted: Wanted
    separator: str | None
    units: dict[str, str]  # by the column's name, where the first line tells them


def layout_of(lines: Lines, table: Table, warnings: list[str]) -> Layout:
    """How a file is written. Raises InputError where it lacks a column that is wanted."""
    if not len(lines) and table.named:
        right = f"it begins with the line {_header(table)}"
        raise mistake(lines.file, 1, 1, "the file is empty", right)
    lines = replace(lines, texts=[unquoted(text) for text in lines.texts])
    first = _names_in(lines.texts[0]) if len(lines) else []
    body = replace(lines[1:], ended=lines.ended or len(lines) == 1) if first else lines
    if not first and table.named and _names_all(remarked := _names_in(lines.remark), table):
        first = remarked
    if first:
        found = _by_names(lines, first, table, warnings)
        places, widths, units = found if found else (table.places, table.widths, {})
    else:
        places, widths, units = _by_places(lines, table, warnings)
    body, separator = plain(body, lines, places, widths, warnings)
    columns = table.columns
    wanted = Wanted(
        tuple(column.name for column in columns),
        tuple(places),
        widths,
        frozenset(column.name for column in columns if column.maybe),
        frozenset(column.name for column in columns if column.positive),
        tuple(column.largest for column in columns),
        f"{table.wanted} ({SCHEMA})",
    )
    return Layout(body, wanted, separator, units)


def unquoted(text: str) -> str:
    """A line without quotes, as long as it was: a comma within them is a decimal comma.

    >>> unquoted('"0,5","1"')
    ' 0.5 , 1 '
    """
    if '"' not in text:
        return text
    parts = text.split('"')
    if all("," not in part or is_number(part.translate(POINT)) for part in parts[1::2]):
        parts[1::2] = [part.translate(POINT) for part in parts[1::2]]
    return " ".join(parts)


def _names_in(line: str) -> list[Named]:
    """The names in a first line; none where it is a row of numbers."""
    if not line:
        return []
    mark = separator_of(line) or ("\t" if "\t" in line.strip() else None)
    fields = [field.strip() for field in line.strip().split(mark)]
    while fields and not fields[-1]:
        fields.pop()
    numbers = [is_number(field) for field in fields]
    are_names = not any(numbers) and any(field[:1].isalpha() for field in fields)
    return [named(field) for field in fields] if are_names else []


def _names_all(names: list[Named], table: Table) -> bool:
    """Whether a comment above the rows names all columns that are wanted."""
    return bool(names) and all(
        len(_exactly(column, names) or _nearly(column, names, table)) == 1
        for column in table.columns
    )


def _by_names(
    lines: Lines, first: list[Named], table: Table, warnings: list[str]
) -> tuple[tuple[int, ...], range, dict[str, str]] | None:
    """Where the columns stand that a first line names; None where it names none of a file that goes
    by places.
    """
    places, units, taken, missing = list[int](), dict[str, str](), list[str](), list[Mistake]()
    at = Place(lines.file, lines.numbers[0], 1)
    for column in table.columns:
        here = _exactly(column, first) or _nearly(column, first, table)
        if len(here) != 1:
            missing.append(_missing(at, column, here, first))
            continue
        (place,) = here
        places.append(place)
        found = first[place]
        if found.unit is not None:
            units[column.name] = found.unit
        if found.whole not in column.names:
            unit = f" in {found.unit}" if found.unit else ""
            taken.append(f"{quoted(found.whole)} is taken as {column.name}{unit}")
    if missing and not table.named:
        told = "no row of numbers: left out; the columns go by their places"
        warnings.append(f"{at.file}:{at.line}: the first line is {told}: {table.wanted}")
        return None
    if missing:
        last = missing[-1]
        missing[-1] = replace(last, right=f"{last.right}; {table.wanted} ({SCHEMA})")
        raise InputError(missing)
    if taken:
        warnings.append(f"{at.file}:{at.line}: {', '.join(taken)}")
    elif not table.named:
        told = "the first line names the columns: they are read by these names"
        warnings.append(f"{at.file}:{at.line}: {told}")
    return tuple(places), range(len(first), len(first) + 1), units


def _exactly(column: Column, first: list[Named]) -> list[int]:
    """The places of a column that goes by one of its own names."""
    return [i for i, one in enumerate(first) if one.whole in column.names] or [
        i for i, one in enumerate(first) if one.name in column.names
    ]


def _nearly(column: Column, first: list[Named], table: Table) -> list[int]:
    """The places of names that leave no doubt and belong to no other column."""
    known = {name for other in table.columns if other != column for name in other.names}
    return [
        i
        for i, one in enumerate(first)
        if one.name in OTHERS.get(column.name, ()) and one.whole not in known
    ]


def _missing(at: Place, column: Column, here: list[int], first: list[Named]) -> Mistake:
    """That a column is not there, or several times."""
    shown = " or ".join(map(quoted, (column.name, *column.also)))
    wrong = f"{len(here)} columns are named {shown}" if here else f"no column is named {shown}"
    listed = [one.whole for one in first]
    likely = (*column.names, *OTHERS.get(column.name, ()))
    near = [n for name in likely for n in difflib.get_close_matches(name, listed, 1)]
    right = f"found {', '.join(map(quoted, listed))}"
    if near and not here:
        right += f"; did you mean {quoted(near[0])}?"
    return Mistake(at, "", wrong, right)


def _by_places(
    lines: Lines, table: Table, warnings: list[str]
) -> tuple[tuple[int, ...], range, dict[str, str]]:
    """Where the columns stand of a file whose first line is a row of numbers."""
    if not table.named:
        return table.places, table.widths, {}
    count = len(table.columns)
    widths = range(count, count + 1)
    rows = lines.texts[:SAMPLE]
    if not any(_fits(rows, way, range(count), widths) for way in WAYS):
        wrong = f"{quoted(lines.texts[0])} names no columns"
        right = f"the first line says what they are: {_header(table)} ({SCHEMA})"
        raise mistake(lines.file, lines.numbers[0], 1, wrong, right)
    told = f"no first line names the columns: taken as {_header(table)}"
    warnings.append(f"{lines.file}:{lines.numbers[0]}: {told}")
    return tuple(range(count)), widths, {}


def _header(table: Table) -> str:
    return ",".join(column.name for column in table.columns)


def plain(
    body: Lines,
    lines: Lines,
    places: tuple[int, ...],
    widths: range,
    warnings: list[str],
) -> tuple[Lines, str | None]:
    """The rows with points in their numbers, and what stands between the columns."""
    rows = body.texts[:SAMPLE]
    fit = [_fits(rows, way, places, widths) for way in WAYS]
    if not rows:
        return body, None
    if not any(fit):
        blank = [text.translate(BLANK) for text in rows]  # commas and white space both separate
        if _fits(blank, (None, False), places, widths):
            return replace(body, texts=[text.translate(BLANK) for text in body.texts]), None
        return body, separator_of(lines.texts[0])
    separator, has_commas = WAYS[fit.index(max(fit))]
    if has_commas:
        told = "the commas in its numbers are taken as decimal points"
        warnings.append(f"{body.file}:{body.numbers[0]}: {told}")
        body = replace(body, texts=[text.translate(POINT) for text in body.texts])
    return body, separator


def _fits(
    rows: list[str],
    way: tuple[str | None, bool],
    places: tuple[int, ...] | range,
    widths: range,
) -> int:
    """How many of some rows hold numbers where they are wanted, if written in some way."""
    separator, has_commas = way
    count = 0
    for row in rows:
        text = row.translate(POINT) if has_commas else row
        fields = (text.rstrip().removesuffix(separator) if separator else text).split(separator)
        count += len(fields) in widths and all(is_number(fields[place]) for place in places)
    return count
