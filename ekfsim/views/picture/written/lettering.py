"""Any text a person may have written, made fit for a picture:
short, on few lines, and with glyphs for every sign.
"""

import textwrap
import unicodedata
from collections.abc import Iterable
from functools import cache

from matplotlib.font_manager import FontProperties, fontManager, get_font

from ekfsim.printable import some

FAMILY = "DejaVu Sans"  # comes with matplotlib
OTHERS = (  # for the signs it lacks, where one of them is installed
    "Noto Sans CJK JP",
    "Noto Sans CJK SC",
    "Source Han Sans",
    "WenQuanYi Micro Hei",
    "Hiragino Sans",
    "PingFang SC",
    "Apple SD Gothic Neo",
    "Yu Gothic",
    "Microsoft YaHei",
    "Malgun Gothic",
    "Arial Unicode MS",
    "Noto Emoji",
    "Segoe UI Symbol",
)
SECOND = "\ue000"  # a private sign, in the second column of a wide one
MISSING = "□"  # stands for a sign that no font at hand can draw


def shortened(text: str, width: int) -> str:
    """One line of at most `width` characters.

    >>> shortened("a rather long name", 9)
    'a rather…'
    """
    return "\n".join(wrapped([text], width, 1))


def wrapped(paragraphs: Iterable[str], width: int, most: int) -> list[str]:
    """At most `most` lines of at most `width` characters, wide ones counting twice;
    an ellipsis for the rest.
    """
    lines: list[str] = []
    for paragraph in paragraphs:
        words = " ".join("".join(map(_printable, paragraph)).split())
        lines += (
            line.replace(SECOND, "") for line in textwrap.wrap("".join(map(_widened, words)), width)
        )
    if len(lines) > most:
        lines = [*lines[: most - 1], lines[most - 1][: width - 1].rstrip() + "…"]
    return lines


def drawable(text: str) -> str:
    """The same text with a box for each sign that no font at hand has;
    what has no shape of its own is left out.
    """
    if text.isascii():
        return text
    return "".join(
        sign if sign.isspace() or _has_glyph(sign) else _substitute(sign) for sign in text
    )


def boxes(texts: Iterable[str]) -> list[str]:
    """That pictures of these texts have boxes, and what would be there instead: a line, or none."""
    signs = dict.fromkeys(sign for text in texts if not text.isascii() for sign in text)
    boxed = [sign for sign in signs if drawable(sign) == MISSING != sign]
    right = "install one that has them, such as Noto Sans CJK or Noto Emoji"
    return (
        [f"no font here has {some(boxed)}: in the picture {MISSING} stands for each; {right}"]
        if boxed
        else []
    )


@cache
def families() -> list[str]:
    """The fonts that a text is drawn with, in the order they are asked for a glyph."""
    installed = set(fontManager.get_font_names())
    return [FAMILY, *(name for name in OTHERS if name in installed)]


def _printable(sign: str) -> str:
    """A sign, a space for what breaks lines, nothing for what turns or hides its neighbours."""
    kind = unicodedata.category(sign)
    return " " if kind in ("Cc", "Zl", "Zp") else "" if kind == "Cf" else sign


def _widened(sign: str) -> str:
    return sign + SECOND if unicodedata.east_asian_width(sign) in "WF" else sign


def _substitute(sign: str) -> str:
    return "" if unicodedata.category(sign) in ("Cf", "Mn", "Me") else MISSING


@cache
def _has_glyph(sign: str) -> bool:
    return any(ord(sign) in _glyphs(family) for family in families())


@cache
def _glyphs(family: str) -> frozenset[int]:
    """The code points that a family can draw."""
    path = fontManager.findfont(FontProperties(family=[family]))
    return frozenset(get_font(path).get_charmap())
