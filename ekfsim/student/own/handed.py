"""Motion and sensor as a student's code is handed them: lists are taken, copies are given."""

import dataclasses
import difflib
from collections.abc import Sequence
from typing import Any

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.printable import quoted, short
from ekfsim.raycast.walls import Walls
from ekfsim.student.own.home import HandedError

MOTION = ("f", "F", "G", "M", "Q")
SENSOR = ("h", "H", "R", "residual")


def provided_in(text: str, option: str) -> tuple[str, ...]:
    """The equations that NAME,… names. Raises UsageError for what is none."""
    names = tuple(name.strip() for name in text.split(","))
    known = (*MOTION, *SENSOR)
    for name in names:
        if name not in known:
            raise UsageError(
                f"{option} {short(text)}: there is no equation {quoted(name)}; "
                f"known: {', '.join(known)}"
            )
    return names


class Handed:
    """A model by its equations and its numbers, and nothing else of it.

    provided : which of the equations may be asked for; None: all
    """

    def __init__(
        self, what: str, equations: Sequence[str], model: Any, provided: Sequence[str] | None
    ) -> None:
        self._what, self._model, self._equations = what, model, equations
        self._provided = equations if provided is None else provided
        self._numbers = numbers_of(model)

    def __getattr__(self, name: str) -> Any:
        """An equation or a number of the model. Raises HandedError for what it has not, or what is
        to be written by oneself.
        """
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._provided and name in self._equations:
            return getattr(self, f"_{name}")
        if name in self._equations:
            raise HandedError(f"{self._what}.{name} is not provided; write this one yourself")
        if name in self._numbers:
            value = self._numbers[name]
            return value.copy() if isinstance(value, np.ndarray) else value
        near = difflib.get_close_matches(name, dir(self), 1)
        right = f"did you mean '{near[0]}'?" if near else f"it has {', '.join(dir(self))}"
        raise HandedError(f"{self._what} has no '{name}'; {right}")

    def __dir__(self) -> list[str]:
        """What may be asked for."""
        return sorted({*self._numbers, *(one for one in self._equations if one in self._provided)})


class HandedMotion(Handed):
    """x⁺ = f(x, u): f, F = ∂f/∂x, G = ∂f/∂u, M and Q, for lists as well as arrays."""

    def __init__(self, motion: Motion, n: int, provided: Sequence[str] | None = None) -> None:
        super().__init__("motion", MOTION, motion, provided)
        self._n = n

    def _f(self, x: Any, u: Any) -> Array:
        """The next state : (…, n)"""
        return np.array(self._model.f(*self._given(x, u)))

    def _F(self, x: Any, u: Any) -> Array:
        """∂f/∂x : (…, n, n)"""
        return np.array(self._model.F(*self._given(x, u)))

    def _G(self, x: Any, u: Any) -> Array:
        """∂f/∂u : (…, n, m)"""
        return np.array(self._model.G(*self._given(x, u)))

    def _M(self, u: Any) -> Array:
        """Covariance of the input's noise : (…, m, m)"""
        return np.array(self._model.M(self._input(u)))

    def _Q(self, u: Any) -> Array:
        """Covariance of the process noise : (n, n), zeros where there is none"""
        Q = np.asarray(self._model.Q(self._input(u)), float)
        return np.array(Q if Q.ndim else np.full((self._n, self._n), Q))

    def _given(self, x: Any, u: Any) -> tuple[Array, Array]:
        return vector("motion", "x", x, self._n), self._input(u)

    def _input(self, u: Any) -> Array:
        return vector("motion", "u", u, len(self._model.inputs))


class HandedSensor(Handed):
    """z = h(x): h, H = ∂h/∂x, R and the residual z − h, for lists as well as arrays."""

    def __init__(self, sensor: Sensor, n: int, provided: Sequence[str] | None = None) -> None:
        super().__init__("sensor", SENSOR, sensor, provided)
        self._n = n

    def _h(self, x: Any) -> Array:
        """The reading that the state x predicts : (…, k)"""
        return np.array(self._model.h(vector("sensor", "x", x, self._n)))

    def _H(self, x: Any) -> Array:
        """∂h/∂x : (…, k, n)"""
        return np.array(self._model.H(vector("sensor", "x", x, self._n)))

    def _R(self, x: Any) -> Array:
        """Covariance of the reading's noise : (…, k, k)"""
        return np.array(self._model.R(vector("sensor", "x", x, self._n)))

    def _residual(self, z: Any, h: Any) -> Array:
        """ν = z − h : (…, k), wrapped where it is an angle"""
        k = len(self._model.outputs)
        one = k == 1
        z, h = (np.atleast_1d(np.asarray(part, float)) if one else part for part in (z, h))
        return np.array(
            self._model.residual(vector("sensor", "z", z, k), vector("sensor", "h", h, k))
        )


def vector(what: str, name: str, value: Any, n: int) -> Array:
    """A vector of n numbers, or many : (…, n). Raises HandedError for what is none."""
    try:
        array = np.asarray(value, float)
    except (TypeError, ValueError):
        raise HandedError(f"{what} was given {name} that is no array of numbers") from None
    if array.ndim == 0 or array.shape[-1] != n:
        raise HandedError(f"{what} was given {name} of shape {array.shape}, not ({n},)")
    return array


def numbers_of(model: Any) -> dict[str, Any]:
    """The numbers of a model by their names; of straight walls their ends, walls : (n, 2, 2) m, and
    of round ones centre and radius, circles : (n, 3) m
    """
    found: dict[str, Any] = {}
    for one in dataclasses.fields(model):
        value = getattr(model, one.name)
        if isinstance(value, Walls):
            found["circles"] = value.circles
            value = value.segments
        if isinstance(value, tuple) and not any(map(dataclasses.is_dataclass, value)):
            value = np.array(value, float)
        if isinstance(value, bool | int | float | np.ndarray):
            found[one.name] = value
    return found


def _named(kind: type, what: str, equations: Sequence[str]) -> None:
    """Let Python's own words of a wrong call say motion.F(), as the student wrote it."""
    for name in equations:
        getattr(kind, f"_{name}").__qualname__ = f"{what}.{name}"


_named(HandedMotion, "motion", MOTION)
_named(HandedSensor, "sensor", SENSOR)
