"""Lines of text broken to the width of a pane; a number is never broken where it fits at all."""

from ekfsim.views.terminal.braille import cells, shorten

FURTHER = "  "  # a line that goes on stands further in than its first


def wrapped(line: str, columns: int) -> list[str]:
    """A printable line in as many as it takes of so many cells.

    >>> wrapped("  x is 0.5, y is 0.25", 12)
    ['  x is 0.5,', '   y is 0.25']
    """
    if cells(line) <= columns:
        return [line]
    inside = " " * (len(line) - len(line.lstrip(" ")))
    further = (inside + FURTHER)[: max(columns // 4, 0)]
    lines, begun = [], inside[: max(columns // 2, 0)]
    fresh = True
    for word in line.split():
        longer = begun + word if fresh else f"{begun} {word}"
        if cells(longer) <= columns:
            begun, fresh = longer, False
            continue
        if not fresh:
            lines.append(begun)
        begun = further + word
        while cells(begun) > columns:
            cut = _fitting(begun, columns)
            lines.append(begun[:cut])
            begun = further + begun[cut:]
        fresh = False
    return [*lines, begun]


def within(text: str, columns: int, most: int, ascii: bool) -> list[str]:
    """A printable text in at most so many lines; where that is too little, with an ellipsis after
    a whole word: half a number would be another number.

    >>> within("off by 28.4 cm and 11.3°, before by 3.2 cm", 16, 2, False)
    ['off by 28.4 cm', '  and 11.3°,…']
    """
    lines = wrapped(text, columns)
    if len(lines) <= most:
        return lines
    dots = "..." if ascii else "…"
    last = wrapped(lines[most - 1], columns - len(dots))[0] if columns > len(dots) else ""
    return [*lines[: most - 1], shorten(last + dots, columns, ascii)]


def _fitting(text: str, columns: int) -> int:
    """How many characters of a text fit into so many cells: at least one more than stands in."""
    count, used = 0, 0
    for character in text:
        used += cells(character)
        if used > columns:
            break
        count += 1
    return max(count, len(text) - len(text.lstrip(" ")) + 1)
