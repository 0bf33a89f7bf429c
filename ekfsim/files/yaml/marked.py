"""Values with their places in a file, and what unquoted text means.

It is read as in YAML 1.2, where `1e-3` is a number and `no` is text.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from ekfsim.printable import short

LARGE = 2.0**53  # from there on a float does not tell which whole number was written

Path = tuple[str | int, ...]  # keys and indices from the top of a file to a value
Mark = tuple[int, int]  # line, column; both from 1


class Nothing:
    """The null of YAML. No key of any file may hold it,
    so that it equals nothing that is allowed.
    """


NOTHING = Nothing()
Scalar = str | int | float | bool | Nothing


@dataclass(slots=True)
class Node:
    """A value and where it stands."""

    mark: Mark
    value: "Scalar | list[Node] | dict[str, Node]"
    written: str = ""  # a scalar as it was written
    quoted: bool = False
    keys: dict[str, Mark] = field(default_factory=dict)  # where the keys of a mapping stand
    faulty: bool = False  # a mistake was already told of it: nothing more is
    values: int = 1  # in it, aliases written out
    levels: int = 1

    def nearest(self, path: Sequence[str | int]) -> "Node":
        """The value at a path, or the last one on the way there."""
        node = self
        for part in path:
            inner = node.get(part)
            if inner is None:
                break
            node = inner
        return node

    def at(self, path: Sequence[str | int]) -> "Node | None":
        """The value at a path, or None where there is none."""
        node: Node | None = self
        for part in path:
            node = node.get(part) if node else None
        return node

    def get(self, part: str | int) -> "Node | None":
        """The value under one key or index, or None."""
        if isinstance(self.value, dict) and isinstance(part, str):
            return self.value.get(part)
        if isinstance(self.value, list) and isinstance(part, int) and part < len(self.value):
            return self.value[part]
        return None

    def plain(self) -> object:
        """Plain dicts, lists and scalars, without places. Whole numbers may be written 7.0 or 1e3:
        in JSON they are.
        """
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        if isinstance(self.value, float) and self.value.is_integer() and abs(self.value) < LARGE:
            return int(self.value)
        return self.value

    def walk(self, path: Path = ()) -> "Iterator[tuple[Path, Node]]":
        """Every value with its path, in the order of the file."""
        yield path, self
        if isinstance(self.value, dict):
            for key, node in self.value.items():
                yield from node.walk((*path, key))
        elif isinstance(self.value, list):
            for index, node in enumerate(self.value):
                yield from node.walk((*path, index))


def field_of(path: Sequence[str | int]) -> str:
    """How messages name a path.

    >>> field_of(("obstacles", 1, "points"))
    'obstacles[1].points'
    """
    return "".join(
        f"[{part}]" if isinstance(part, int) else f".{short(part)}" for part in path
    ).removeprefix(".")


INTEGER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
FLOAT = re.compile(
    r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"
)


def scalar(text: str) -> Scalar:
    """What unquoted text means in YAML 1.2.

    >>> scalar("1e-3"), scalar("no"), scalar("010"), scalar("0x10"), scalar("1_000")
    (0.001, 'no', 10, 16, '1_000')
    """
    if text in ("", "~", "null", "Null", "NULL"):
        return NOTHING
    if text in ("true", "True", "TRUE", "false", "False", "FALSE"):
        return text[0] in "tT"
    if text[0] not in "+-.0123456789":
        return text
    if INTEGER.fullmatch(text) and len(text) <= 300:
        return int(text, base={"0o": 8, "0x": 16}.get(text[:2], 10))
    if FLOAT.fullmatch(text):
        return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
    return text
