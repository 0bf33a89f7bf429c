"""Delta debugging: the smallest set of changes of which something is still true (Zeller &
Hildebrandt, Simplifying and Isolating Failure-Inducing Input, 2002, ddmin).
"""

import itertools
from collections.abc import Callable, Sequence
from typing import TypeVar

T = TypeVar("T")


class SpentError(Exception):
    """The budget does not allow another trial."""


def minimal(items: Sequence[T], holds: Callable[[tuple[T, ...]], bool]) -> tuple[T, ...]:
    """A part of the items of which it holds, and of which none can be spared; they must do so all
    together. Where `holds` raises SpentError, the smallest part so far.
    """
    kept, parts = tuple(items), 2
    tried: dict[frozenset[int], bool] = {}
    place = {id(item): number for number, item in enumerate(items)}

    def true(some: tuple[T, ...]) -> bool:
        key = frozenset(place[id(item)] for item in some)
        if key not in tried:
            tried[key] = holds(some)
        return tried[key]

    try:
        while len(kept) > 1:
            some = _parts(kept, parts)
            rest = [tuple(item for item in kept if item not in part) for part in some]
            smaller = next((part for part in some if true(part)), None)
            if smaller is not None:
                kept, parts = smaller, 2
                continue
            smaller = next((part for part in rest if part and true(part)), None)
            if smaller is not None:
                kept, parts = smaller, max(parts - 1, 2)
                continue
            if parts >= len(kept):
                break
            parts = min(2 * parts, len(kept))
    except SpentError:
        pass
    return kept


def _parts(items: tuple[T, ...], n: int) -> list[tuple[T, ...]]:
    """The items in n parts of nearly one size."""
    cuts = [round(i * len(items) / n) for i in range(n + 1)]
    return [items[a:b] for a, b in itertools.pairwise(cuts)]
