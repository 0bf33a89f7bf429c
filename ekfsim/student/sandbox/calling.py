"""Over there: the student's code itself, loaded once and called for one run after another."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import load
from ekfsim.student.sandbox.told import Listener


class Requests:
    """What may be asked, by its name; the code is loaded when it is first."""

    def __init__(self, place: str, label: str, provided: Sequence[str] | None) -> None:
        self._place, self._label, self._provided = place, label, provided
        self._caller: InProcess | None = None
        self._listener = Listener()

    def begin(self, x: list[float], P: list[float]) -> bytes:
        """A run begins."""
        self._loaded().begin(np.array(x), _square(P))
        return b""

    def call(self, *told: Any) -> bytes:
        """x and P, one after the other : (n + n²,)"""
        answer = self._loaded().call(self._asked(*told))
        return _packed(answer.x) + _packed(answer.P)

    def _loaded(self) -> InProcess:
        if self._caller is None:
            try:
                code = load(self._place)
            except UsageError as error:  # no filter in it
                place, _, wrong = str(error).partition(": ")
                raise FaultError(place, wrong) from None
            if isinstance(code.form, Whole):
                wrong = "is a class of the full protocol; write predict(u, motion) and update(…)"
                raise FaultError(self._label, wrong)
            self._caller = InProcess(code, self._provided)
        return self._caller

    def _asked(
        self, new: list[Any], slot: int, x: list[float], P: list[float], value: list[float],
        headings: list[int], moves: bool,
    ) -> Asked:  # fmt: skip
        self._listener.hear(new)
        model = self._listener.models[slot]
        given = Control(model, np.array(value)) if moves else Reading(model, np.array(value))
        return Asked(np.array(x), _square(P), given, tuple(headings))


def _square(P: list[float]) -> Array:
    n = round(len(P) ** 0.5)
    return np.array(P).reshape(n, n)


def _packed(array: Array) -> bytes:
    return array.astype("<f8").tobytes()
