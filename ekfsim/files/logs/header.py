"""The first line of a table with names."""

import difflib
import re
from collections.abc import Sequence

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.text import Lines
from ekfsim.files.source import mistake
from ekfsim.files.yaml.telling import quoted

PARTED = re.compile(r"\s*([-+]?\d+(,\d+)?([eE][-+]?\d+)?)?\s*")


def separator_of(line: str) -> str | None:
    """What stands between the columns: a comma, else a semicolon, else white space (None). Commas
    within numbers that semicolons part are decimal commas.

    >>> separator_of("t,x"), separator_of("t x"), separator_of("0,5;1,25;2")
    (',', None, ';')
    """
    if ";" in line and all(PARTED.fullmatch(field) for field in line.rstrip().split(";")):
        return ";"
    return next((mark for mark in ",;" if mark in line), None)


def places_of(lines: Lines, columns: Sequence[tuple[str, ...]]) -> tuple[int, list[int]]:
    """How many columns a header names, and where each wanted one stands;
    it may go by any of several names.

    Raises InputError where the header is missing, or lacks one of them.
    """
    wanted = ",".join(names[0] for names in columns)
    if not len(lines):
        raise mistake(lines.file, 1, 1, "the file is empty", f"it begins with the line {wanted}")
    line = lines.texts[0]
    names = [name.strip().strip('"').lower() for name in line.split(separator_of(line))]
    if names and names[-1] == "":
        names.pop()
    place = Place(lines.file, lines.numbers[0], 1)
    if not any(name[:1].isalpha() for name in names):
        wrong = f"{quoted(line)} names no columns"
        raise InputError(
            [Mistake(place, "", wrong, f"the first line says what they are: {wanted}")]
        )
    found, missing = [], list[Mistake]()
    for known in columns:
        here = [i for i, name in enumerate(names) if name in known]
        if len(here) == 1:
            found.append(here[0])
            continue
        shown = " or ".join(map(quoted, known))
        wrong = f"{len(here)} columns are named {shown}" if here else f"no column is named {shown}"
        near = difflib.get_close_matches(known[0], names, 1) if not here else []
        right = f"found {', '.join(map(quoted, names))}" + (
            f"; did you mean {quoted(near[0])}?" if near else ""
        )
        missing.append(Mistake(place, "", wrong, right))
    if missing:
        raise InputError(missing)
    return len(names), found
