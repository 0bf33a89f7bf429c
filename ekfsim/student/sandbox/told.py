"""Motions, sensors and walls in plain numbers, and made again from them.

A model is told once and by its number afterwards: `SLOTS` are remembered on both sides, the oldest
is forgotten first.
"""

import dataclasses
from importlib import import_module
from typing import Any

import numpy as np

from ekfsim.models.sensors.mounted import Mount
from ekfsim.records import Control, Reading

MODELS = "ekfsim.models."
WALLS = "ekfsim.raycast.walls"  # the one part of a model that is no model
SLOTS = 64

# an input or a reading: models that are new, the number of its own, u or z, whether it is a motion
Told = tuple[list[tuple[int, Any]], int, list[float], bool]


class Teller:
    """The side that has the models."""

    def __init__(self) -> None:
        self._held: list[Any] = [None] * SLOTS  # as long as it is held its id is its own
        self._slots: dict[int, int] = {}
        self._next = 0
        self._new: list[tuple[int, Any]] = []

    def told(self, given: Control | Reading) -> Told:
        """An input or a reading; of its model, what the other side has not been told yet."""
        match given:
            case Control(motion, u):
                slot, value, moves = self._slot(motion), u, True
            case Reading(sensor, z):
                slot, value, moves = self._slot(sensor), z, False
        new, self._new = self._new, []
        return new, slot, value.tolist(), moves

    def _slot(self, model: Any) -> int:
        """The number of a model."""
        known = self._slots.get(id(model))
        if known is not None:
            return known
        told = self._told(model)
        slot, self._next = self._next, (self._next + 1) % SLOTS
        self._slots.pop(id(self._held[slot]), None)
        self._held[slot], self._slots[id(model)] = model, slot
        self._new.append((slot, told))
        return slot

    def _told(self, model: Any) -> list[Any]:
        kind = type(model)
        if not dataclasses.is_dataclass(model) or not _ours(kind.__module__):
            raise TypeError(f"{kind.__qualname__} is no model of ekfsim's; it cannot be told")
        values = [self._value(getattr(model, one.name)) for one in dataclasses.fields(model)]
        return ["model", kind.__module__, kind.__qualname__, values]

    def _value(self, value: Any) -> Any:
        match value:
            case bool() | int() | float() | str() | None:
                return value
            case Mount():
                return ["model", type(value).__module__, "Mount", [*value]]
            case np.ndarray():
                return ["array", value.dtype.str, value.shape, value.ravel().tolist()]
            case tuple():
                return ["tuple", [self._value(part) for part in value]]
            case _ if type(value).__module__ == WALLS:  # large, and the same for many sensors
                return ["slot", self._slot(value)]
            case _:
                return self._told(value)


class Listener:
    """The side that makes them again."""

    def __init__(self) -> None:
        self._models: list[Any] = [None] * SLOTS

    def given(self, told: Told) -> Control | Reading:
        """What was told."""
        new, slot, value, moves = told
        for number, model in new:
            self._models[number] = self._made(model)
        kind = Control if moves else Reading
        return kind(self._models[slot], np.array(value))

    def _made(self, told: Any) -> Any:
        match told:
            case ["array", str(kind), shape, numbers]:
                return np.array(numbers, kind).reshape(shape)
            case ["tuple", parts]:
                return tuple(map(self._made, parts))
            case ["slot", slot]:
                return self._models[slot]
            case ["model", str(module), str(name), values] if _ours(module):
                return getattr(import_module(module), name)(*map(self._made, values))
            case bool() | int() | float() | str() | None:
                return told
        raise TypeError(f"{told!r} is no part of a model")


def _ours(module: str) -> bool:
    return module.startswith(MODELS) or module == WALLS
