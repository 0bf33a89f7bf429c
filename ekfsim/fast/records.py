"""Many records of one kind at once: a frozen dataclass takes most of its time to be made."""

from collections import deque
from collections.abc import Iterable
from itertools import repeat
from typing import Any, TypeVar

T = TypeVar("T")


def records(kind: type[T], n: int, *columns: Iterable[Any]) -> list[T]:
    """n records of a dataclass with slots, all fields of which are given, as columns of n or
    more.
    """
    made = list(map(object.__new__, repeat(kind, n)))
    for name, column in zip(kind.__match_args__, columns, strict=True):  # type: ignore[attr-defined]
        deque(map(vars(kind)[name].__set__, made, column), maxlen=0)
    return made
