"""What goes between the two processes: a head, then text or plain numbers. Nothing is unpickled.

    head     16 bytes: how many follow (4), what they are (1), nothing (3), the mark (8)
    REQUEST  JSON: [seconds, [[what, [of what]], …]]
    NUMBERS  float64, the lowest byte first
    WORDS    UTF-8
    FAULT    UTF-8: where, and what is wrong

Each question of a request has an answer of its own, up to the first fault, which ends the request.
The mark is drawn anew for each request: what comes without it was written before it was asked for,
or by somebody else.
"""

from collections.abc import Sequence
from struct import Struct, pack
from typing import NamedTuple

HEAD = Struct("<IB3x8s")
REQUEST, NUMBERS, WORDS, FAULT = range(4)
MOST = {NUMBERS: 2**20, WORDS: 4000, FAULT: 4000}  # bytes of what is answered
BETWEEN = "\0"  # where and what

Numbers = Sequence[float]


class Message(NamedTuple):
    """One message, as it went."""

    kind: int
    mark: bytes
    content: bytes


def packed(message: Message) -> bytes:
    """As it goes over."""
    kind, mark, content = message
    return HEAD.pack(len(content), kind, mark) + content


def answered(answer: Numbers | str, mark: bytes) -> bytes:
    """An answer as it goes over."""
    if isinstance(answer, str):
        return packed(Message(WORDS, mark, answer.encode(errors="replace")[: MOST[WORDS]]))
    return packed(Message(NUMBERS, mark, pack(f"<{len(answer)}d", *answer)))


def faulted(place: str, wrong: str, mark: bytes) -> bytes:
    """A fault as it goes over."""
    content = f"{place}{BETWEEN}{wrong}".encode(errors="replace")
    return packed(Message(FAULT, mark, content[: MOST[FAULT]]))


def fault_of(content: bytes) -> tuple[str, str]:
    """Where, and what is wrong."""
    place, _, wrong = content.decode(errors="replace").partition(BETWEEN)
    return place, wrong
