"""Any text that a file or a name may hold, made harmless for a terminal, and for a line."""

import re
from collections.abc import Sequence

# Controls, bytes of a name that are no text, and signs without a shape that turn or hide what
# stands around them.
UNSHOWN = re.compile(
    "[\x00-\x09\x0b-\x1f\x7f-\x9f\xad\u061c\u115f\u1160\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\u3164"
    "\ufeff\uffa0\ufff9-\ufffb\ud800-\udfff\U000e0000-\U000e0fff]"
)


def shown(text: object) -> str:
    r"""A text, in which the name of a file may stand, as it does no harm to a terminal.

    >>> print(shown("red\x1b[31m.yaml"), shown("gnp.exe\u202e"))
    red\x1b[31m.yaml gnp.exe\u202e
    """
    told = str(text)
    if told.isascii() and told.replace("\n", "").isprintable():  # as is nearly all, and soon seen
        return told
    return UNSHOWN.sub(lambda found: _escape(ord(found[0])), told)


def in_a_line(text: object) -> str:
    r"""The same, with its line breaks, too.

    >>> print(in_a_line("a\nb"))
    a\x0ab
    """
    return shown(text).replace("\n", "\\x0a")


def short(text: str, most: int = 40) -> str:
    """At most so many characters of a text."""
    return text if len(text) <= most else text[: most - 3] + "..."


def quoted(text: str) -> str:
    r"""Text in quotes, on one line, and short.

    >>> print(quoted("a\nb"), quoted("a" * 99))
    'a b' 'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...'
    """
    return f"'{shown(short(' '.join(text[:1000].split())))}'"


def some(names: Sequence[str], most: int = 12) -> str:
    """Names with commas between, the first ones of many.

    >>> some(["desk", "shelf"]), some(["a", "b", "c"], most=2)
    ('desk, shelf', 'a, b, …')
    """
    return ", ".join(
        [*(shown(short(name)) for name in names[:most]), *(["…"] if len(names) > most else [])]
    )


def cell(value: object) -> object:
    """A value as it stands in a table; a text that a spreadsheet would calculate, as the name
    =1+1.yaml, behind a '.

    >>> cell("=1+1.yaml"), cell("tour.yaml"), cell(-0.5)
    ("'=1+1.yaml", 'tour.yaml', -0.5)
    """
    return (
        f"'{value}" if isinstance(value, str) and value.startswith(("=", "+", "-", "@")) else value
    )


def _escape(code: int) -> str:
    """How a sign is written that is not shown; a byte that is no text by its number."""
    if 0xDC80 <= code <= 0xDCFF:
        code -= 0xDC00
    return (
        f"\\x{code:02x}"
        if code < 0x100
        else f"\\u{code:04x}"
        if code < 0x10000
        else f"\\U{code:08x}"
    )
