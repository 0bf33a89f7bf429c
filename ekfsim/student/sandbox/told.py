"""Motions, sensors and walls in plain numbers, and made again from them.

A model is told once and by its number afterwards: `SLOTS` are remembered on both sides, the oldest
is forgotten first.
"""

import dataclasses
from importlib import import_module
from typing import Any

import numpy as np

MODELS = "ekfsim.models."
WALLS = "ekfsim.raycast.walls"  # the one part of a model that is no model
SLOTS = 64


class Teller:
    """The side that has the models."""

    def __init__(self) -> None:
        self._held: list[Any] = [None] * SLOTS  # as long as it is held its id is its own
        self._slots: dict[int, int] = {}
        self._next = 0
        self._new: list[tuple[int, Any]] = []

    def slot(self, model: Any) -> int:
        """The number of a model; what it is, is told with the next request."""
        known = self._slots.get(id(model))
        if known is not None:
            return known
        told = self._told(model)
        slot, self._next = self._next, (self._next + 1) % SLOTS
        self._slots.pop(id(self._held[slot]), None)
        self._held[slot], self._slots[id(model)] = model, slot
        self._new.append((slot, told))
        return slot

    def new(self) -> list[tuple[int, Any]]:
        """What the other side has not been told yet."""
        new, self._new = self._new, []
        return new

    def _told(self, model: Any) -> list[Any]:
        kind = type(model)
        if not dataclasses.is_dataclass(model) or not _ours(kind.__module__):
            raise TypeError(f"{kind.__qualname__} is no model of ekfsim's; it cannot be told")
        values = [self._value(getattr(model, one.name)) for one in dataclasses.fields(model)]
        return ["model", kind.__module__, kind.__qualname__, values]

    def _value(self, value: Any) -> Any:
        match value:
            case bool() | int() | float() | str():
                return value
            case np.ndarray():
                return ["array", value.dtype.str, value.shape, value.ravel().tolist()]
            case tuple():
                return ["tuple", [self._value(part) for part in value]]
            case _ if type(value).__module__ == WALLS:  # large, and the same for many sensors
                return ["slot", self.slot(value)]
            case _:
                return self._told(value)


class Listener:
    """The side that makes them again."""

    def __init__(self) -> None:
        self.models: list[Any] = [None] * SLOTS

    def hear(self, new: list[tuple[int, Any]]) -> None:
        """Take in what the other side tells."""
        for slot, told in new:
            self.models[slot] = self._made(told)

    def _made(self, told: Any) -> Any:
        match told:
            case ["array", str(kind), shape, numbers]:
                return np.array(numbers, kind).reshape(shape)
            case ["tuple", parts]:
                return tuple(map(self._made, parts))
            case ["slot", slot]:
                return self.models[slot]
            case ["model", str(module), str(name), values] if _ours(module):
                return getattr(import_module(module), name)(*map(self._made, values))
            case bool() | int() | float() | str():
                return told
        raise TypeError(f"{told!r} is no part of a model")


def _ours(module: str) -> bool:
    return module.startswith(MODELS) or module == WALLS
