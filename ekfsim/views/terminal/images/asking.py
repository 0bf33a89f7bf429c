"""A terminal is asked whether it draws images, and how. What it does not answer it cannot.

All questions are put at once. The last one, on its attributes (DA1), is one that every terminal
answers, and they answer in order: when that answer has come, no other will.

https://sw.kovidgoyal.net/kitty/graphics-protocol/#querying-support-and-available-transmission-mediums
https://iterm2.com/feature-reporting/
https://invisible-island.net/xterm/ctlseqs/ctlseqs.html: CSI 14 t, CSI 16 t, XTSMGRAPHICS, DA1
"""

import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from ekfsim.views.terminal.keys.sources import Source

PATIENCE = 0.5  # s for all answers
# of kitty whether it would take one pixel; of iTerm2 its features; the size of a cell and that of
# all cells; how many colours a sixel image may have, and how many pixels; the attributes
QUESTIONS = (
    "\x1b_Gi=1,a=q,t=d,f=24,s=1,v=1;AAAA\x1b\\"
    "\x1b]1337;Capabilities\x1b\\"
    "\x1b[16t\x1b[14t"
    "\x1b[?1;1;0S\x1b[?2;1;0S"
    "\x1b[c"
)
ANSWER = re.compile(
    rb"\x1b_G(?P<kitty>[^\x1b]*)\x1b\\"
    rb"|\x1b\]1337;Capabilities=(?P<iterm2>[^\x07\x1b]*)(?:\x07|\x1b\\)"
    rb"|\x1b\[(?P<size>\d+;\d+;\d+)t"
    rb"|\x1b\[\?(?P<sixel>[\d;]+)S"
    rb"|\x1b\[\?(?P<attributes>[\d;]*)c"
)
ONE, ALL = 6, 4  # cells whose size is told
SIXEL = 4  # among the attributes
FILE = r"F(?![a-z])"  # among the features of iTerm2: it shows files that are images
USUAL_CELL = 10, 20  # px, where a terminal that scales images does not tell
COLOURS = 256  # of a sixel image, where the terminal does not tell of fewer


class Protocol(Enum):
    """How a terminal is told an image."""

    KITTY = "kitty"
    ITERM2 = "iTerm2"
    SIXEL = "sixel"


@dataclass(frozen=True, slots=True)
class Means:
    """What a terminal can draw."""

    protocol: Protocol
    cell: tuple[int, int] = USUAL_CELL  # width and height in px
    colours: int = COLOURS  # of a sixel image
    largest: tuple[int, int] | None = None  # width and height of one in px, where there is a limit


def ask(
    source: Source,
    write: Callable[[str], object],
    size: tuple[int, int],
    pixels: tuple[int, int] = (0, 0),
) -> tuple[Means | None, bytes]:
    """What the terminal can draw, and the keys that were typed in the meantime.
    size : its columns and rows; pixels : its width and height, 0 where the system does not know
    """
    write(QUESTIONS)
    read, deadline = b"", time.monotonic() + PATIENCE
    while not _over(read) and (left := deadline - time.monotonic()) > 0:
        arrived = source(left)
        if not arrived:
            break
        read += arrived
    return means(read, size, pixels), ANSWER.sub(b"", read)


def means(read: bytes, size: tuple[int, int], pixels: tuple[int, int] = (0, 0)) -> Means | None:
    r"""What a terminal can draw, by what it answered. size, pixels : as of `ask`

    >>> means(b"\x1b[6;16;8t\x1b[?62;4c", (80, 24))
    Means(protocol=<Protocol.SIXEL: 'sixel'>, cell=(8, 16), colours=256, largest=None)
    """
    answers = [(one.lastgroup, one[one.lastgroup].decode(errors="replace"))
               for one in ANSWER.finditer(read) if one.lastgroup]  # fmt: skip
    told = [_numbers(text) for kind, text in answers if kind == "size"]
    cell = _cell([*told, [ALL, *reversed(pixels)]], size)
    if any(kind == "kitty" and text.endswith(";OK") for kind, text in answers):
        return Means(Protocol.KITTY, cell or USUAL_CELL)
    if any(kind == "iterm2" and re.search(FILE, text) for kind, text in answers):
        return Means(Protocol.ITERM2, cell or USUAL_CELL)
    sixels = any(kind == "attributes" and SIXEL in _numbers(text)[1:] for kind, text in answers)
    if not sixels or cell is None:  # which is not scaled: it might cover the text beside it
        return None
    colours, largest = COLOURS, None
    for item, status, *values in (_numbers(text) for kind, text in answers if kind == "sixel"):
        if item == 1 and status == 0 and values and values[0] > 1:
            colours = min(values[0], COLOURS)
        if item == 2 and status == 0 and len(values) == 2 and all(values):
            largest = values[0], values[1]
    return Means(Protocol.SIXEL, cell, colours, largest)


def _over(read: bytes) -> bool:
    """Whether the answer to the last question has come."""
    return any(one.lastgroup == "attributes" for one in ANSWER.finditer(read))


def _cell(told: list[list[int]], size: tuple[int, int]) -> tuple[int, int] | None:
    """Width and height of a cell, as it was told, or else from that of all of them."""
    for kind, share in (ONE, (1, 1)), (ALL, size):
        for which, height, width in told:
            cell = width // share[0], height // share[1]
            if which == kind and all(cell):
                return cell
    return None


def _numbers(text: str) -> list[int]:
    """The numbers between semicolons; nothing is 0.

    >>> _numbers("62;;4")
    [62, 0, 4]
    """
    return [int(number[:9] or 0) for number in text.split(";")]
