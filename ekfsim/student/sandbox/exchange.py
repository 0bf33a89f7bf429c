"""What goes between the two processes: a head, then text or plain numbers. Nothing is unpickled.

head     16 bytes: how many follow (4), what they are (1), 3 unused, the mark (8)
request  JSON: what is asked, from whom
answer   ANSWER: float64, little-endian · FAULT: where and what is wrong, in UTF-8

The mark is drawn anew for each request: what comes without it was written before it was asked for,
or by somebody else.
"""

import struct
from typing import NamedTuple

HEAD = struct.Struct("<IB3x8s")
REQUEST, ANSWER, FAULT = range(3)
MOST_NUMBERS = 2**20  # bytes of one answer
MOST_WORDS = 4000  # bytes of one fault
SEPARATOR = "\0"  # between where and what


class Message(NamedTuple):
    """One message, as it went."""

    kind: int
    mark: bytes
    content: bytes


def packed(message: Message) -> bytes:
    """As it goes over."""
    kind, mark, content = message
    return HEAD.pack(len(content), kind, mark) + content


def fault(place: str, wrong: str) -> bytes:
    """The content of a fault."""
    return f"{place}{SEPARATOR}{wrong}".encode(errors="replace")[:MOST_WORDS]


def fault_of(content: bytes) -> tuple[str, str]:
    """Where, and what is wrong."""
    place, _, wrong = content.decode(errors="replace").partition(SEPARATOR)
    return place, wrong
