"""A table's file → where its columns stand."""

from collections.abc import Mapping
from dataclasses import replace

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.keys.recorded.columns import MotionKeys, ReadingsKeys
from ekfsim.files.keys.recorded.topics import OriginKeys
from ekfsim.files.logs.header import separator_of
from ekfsim.files.logs.named.head import ALSO, absent, fields_of, names_in, place_of, placed
from ekfsim.files.logs.named.opening.derived import EARTH, place_of_first, with_derived
from ekfsim.files.logs.named.opening.ragged import in_groups, levelled
from ekfsim.files.logs.named.tables import Source, Table
from ekfsim.files.logs.table import is_number
from ekfsim.files.logs.tables.layout import SAMPLE, TAB, unquoted
from ekfsim.files.logs.tables.names import named
from ekfsim.files.logs.text import Lines, first_line, lines_of
from ekfsim.files.yaml.telling import quoted

LATITUDE, _ = EARTH
MANY = 8  # kinds of rows that are listed


def opened_all(source: Source, wanted: str) -> list[Table]:
    """A table of readings, or several where a row tells several: one for each of its groups.
    Raises as `opened` does.
    """
    table = opened(source, wanted)
    every = source.keys.every if isinstance(source.keys, ReadingsKeys) else None
    if every is None:
        return [table]
    return [_finished(part, source) for part in in_groups(table, every)]


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
    separator = separator_of(lines.texts[0]) or _tab_of(lines)
    fields = fields_of(lines.texts[0], separator)
    head = None if source.keys.rows else names_in(source.path, fields)
    body = lines
    if head == fields:
        body = replace(lines[1:], ended=lines.ended or len(lines) == 1)
    body = _ended(body, separator, len(fields))
    at = Place(lines.file, lines.numbers[0], 1)
    columns, shared = source.columns(), source.shared()
    if head is None and not columns and not shared:
        raise _nameless(lines, fields, at, wanted)
    width = len(fields)
    if head is None and any(isinstance(one, int) and one > width for one in columns.values()):
        width = max(len(fields_of(text, separator)) for text in body.texts)
    places, units = placed(head or [], at)
    for name, theirs in columns.items():
        place = place_of(theirs, head or [], width)
        if place is None:
            raise absent(at, name, theirs, head)
        places[name] = place
    found = {n: place_of(theirs, head or [], width) for n, theirs in shared.items()}
    there = {name: place for name, place in found.items() if place is not None}
    places = {**places, **there, **{name: places[name] for name in columns}}
    units = {**units, **_stated(places, head or []), **source.units()}
    table = Table(body, separator, width, places, units, frozenset(there), frozenset(columns))
    if isinstance(source.keys, ReadingsKeys) and source.keys.every is not None:
        return table
    return _finished(table if head else levelled(table), source)


def first_place(source: Source) -> OriginKeys | None:
    """Where a table is on the earth at first; None where it tells no latitude. Raises as `opened`
    does.
    """
    if source.path.suffix == ".tum" or source.lines is not None:
        return None
    told = {**source.shared(), **source.columns()}
    head = first_line(source.path).lstrip("#% \t")
    names = {named(field).name for field in fields_of(head, separator_of(head))} if head else set()
    if LATITUDE not in told and names.isdisjoint((LATITUDE, *ALSO[LATITUDE])):
        return None
    return place_of_first(opened(source, ""))


def _finished(table: Table, source: Source) -> Table:
    """The table with the columns that follow from others. Whence a motion is taken is told by name:
    where a receiver is, is no motion.
    """
    of_motion = isinstance(source.keys, MotionKeys)
    return with_derived(table, source.recording.origin, with_fixes=not of_motion)


def _nameless(lines: Lines, fields: list[str], at: Place, wanted: str) -> InputError:
    """The mistake that nothing says what the columns are; where rows begin with words of several
    kinds, how a table takes its own.
    """
    wrong = f"{quoted(lines.texts[0])} names no columns"
    if len(fields) > 1 and not is_number(fields[0]) and all(map(is_number, fields[1:])):
        kinds = ", ".join(map(quoted, _kinds_in(lines)))
        right = (
            f"rows begin with {kinds}: say which are a table's, and where its columns stand, as in "
            f"motion: {{rows: {fields[0]}, columns: {{t: 2, v: 3, omega: 4}}}}"
        )
    else:
        right = f"the first line says what they are: {wanted}; or recording.columns their numbers"
    return InputError([Mistake(at, "", wrong, right)])


def _kinds_in(lines: Lines) -> list[str]:
    """The words with which rows begin, some of them where they are many."""
    firsts = (text.split(separator_of(text), 1)[0].strip() for text in lines.texts)
    kinds = list(dict.fromkeys(firsts))
    return kinds[:MANY] + ["…"] * (len(kinds) > MANY)


def _tab_of(lines: Lines) -> str | None:
    """A tab where all of the first rows have as many between their columns: names and words may
    then hold blanks, and fields be empty.
    """
    counts = {text.count(TAB) for text in lines.texts[:SAMPLE]}
    is_one_each = "" not in lines.texts[0].strip().split(TAB)
    return TAB if len(counts) == 1 and 0 not in counts and is_one_each else None


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
    units = ((name, named(head[place]).unit) for name, place in places.items() if place < len(head))
    return {name: unit for name, unit in units if unit is not None}


def _of_kind(lines: Lines, word: str) -> Lines:
    """The rows that begin with a word. Raises InputError where none does."""
    firsts = [text.split(separator_of(text), 1)[0].strip() for text in lines.texts]
    kept = [i for i, first in enumerate(firsts) if first == word]
    if not kept:
        right = f"they begin with {', '.join(map(quoted, _kinds_in(lines)))}"
        wrong = f"no row begins with {quoted(word)}"
        raise InputError([Mistake(Place(lines.file, 1, 1), "", wrong, right)])
    ended = lines.ended or kept[-1] != len(lines) - 1
    numbers, texts = [lines.numbers[i] for i in kept], [lines.texts[i] for i in kept]
    return Lines(lines.file, numbers, texts, ended)
