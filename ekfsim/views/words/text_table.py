"""Rows of words → the lines of a table, and sentences → lines:
no wider than the terminal that they are read on.
"""

import textwrap
from collections.abc import Iterator, Sequence

GAP = "  "


def aligned(rows: Sequence[Sequence[str]], names: int, width: int | None = None) -> list[str]:
    """The lines of a table; the first `names` columns name the row and are ranged left,
    all others right.

    A table wider than `width` characters is told in parts, one below the other, each with the names
    again.

    >>> aligned([("a", "bb", "ccc"), ("1", "2", "3")], names=1, width=5)
    ['a  bb', '1   2', '', 'a  ccc', '1    3']
    """
    columns = [
        [cell.ljust(most) if number < names else cell.rjust(most) for cell in column]
        for number, column in enumerate(zip(*rows, strict=True))
        for most in [max(map(len, column))]
    ]
    lines: list[str] = []
    for part in _parts([len(column[0]) for column in columns], names, width):
        shown = zip(*(columns[number] for number in (*range(names), *part)), strict=True)
        lines += [*([""] if lines else []), *(GAP.join(row).rstrip() for row in shown)]
    return lines


def _parts(widths: Sequence[int], names: int, width: int | None) -> Iterator[list[int]]:
    """Which columns stand side by side: as many as there is room for, and at least one."""
    beside = sum(widths[:names]) + len(GAP) * max(names - 1, 0)
    part, used = list[int](), beside
    for number in range(names, len(widths)):
        if part and width is not None and used + len(GAP) + widths[number] > width:
            yield part
            part, used = [], beside
        part.append(number)
        used += len(GAP) + widths[number]
    yield part


def folded(sentence: str, width: int | None = None) -> list[str]:
    """The lines of a sentence; those that go on with it stand further in than its first."""
    if width is None:
        return [sentence]
    inside = len(sentence) - len(sentence.lstrip()) + len(GAP)
    return textwrap.wrap(
        sentence,
        max(width, 2 * inside),
        subsequent_indent=" " * inside,
        break_long_words=False,
        break_on_hyphens=False,
    )
