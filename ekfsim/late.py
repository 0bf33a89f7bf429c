"""What is imported when it is first asked for: most of it no run needs."""

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any, Generic, TypeVar

T_co = TypeVar("T_co", covariant=True)


def found(place: str) -> Any:
    """What stands at a place "module:name"."""
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


class Table(Mapping[str, T_co], Generic[T_co]):
    """What stands at places "module:name", by other names; the names are known without them."""

    def __init__(self, places: Mapping[str, str]) -> None:
        self._places = places

    def __getitem__(self, name: str) -> T_co:
        held: T_co = found(self._places[name])
        return held

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)
