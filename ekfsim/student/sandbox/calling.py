"""Over there: the student's code itself, loaded once and called for one run after another."""

import os
from collections.abc import Sequence

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.student.asked import Asked, Caller
from ekfsim.student.fault import FaultError
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.derivatives import derivative
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import Code, load
from ekfsim.student.sandbox.exchange import Numbers
from ekfsim.student.sandbox.told import Listener, Told


class Requests:
    """What may be asked, a method each; numbers or words are answered."""

    def __init__(self, place: str, provided: Sequence[str] | None, fenced: int) -> None:
        self._place, self._provided, self._fenced = place, provided, fenced
        self._found: Code | None = None
        self._callers: dict[int, Caller] = {}
        self._listener = Listener()

    def hello(self) -> Numbers:
        """That all is prepared: which process this is, which version of Landlock is around it."""
        return os.getpid(), self._fenced

    def begin(self, run: int, x: list[float], P: list[float]) -> Numbers:
        """A run begins: x and P where the code has a belief of its own."""
        begun = self._caller(run).begin(np.array(x), _square(P))
        return () if begun is None else (*begun.x.tolist(), *begun.P.ravel().tolist())

    def call(
        self, run: int, x: list[float], P: list[float], told: Told, headings: list[int]
    ) -> Numbers:
        """x and P, one after the other : (n + n²,)"""
        given = self._listener.given(told)
        answer = self._caller(run).call(Asked(np.array(x), _square(P), given, tuple(headings)))
        return (*answer.x.tolist(), *answer.P.ravel().tolist())

    def place_of(self, told: Told) -> str:
        """file:line of what is called for it."""
        return self._caller(0).place_of(self._listener.given(told))

    def derivative(self, name: str, x: list[float], told: Told) -> Numbers:
        """What F, G or H is, row by row."""
        given = self._listener.given(told)
        found = derivative(self._code(), name, np.array(x), given, self._provided)
        return tuple(found.ravel().tolist())

    def _caller(self, run: int) -> Caller:
        caller = self._callers.get(run)
        if caller is None:
            code = self._code()
            if isinstance(code.form, Whole):
                right = "write predict(u, motion) and update(z, sensor) that change x and P"
                raise FaultError(
                    code.label, f"a class of the whole protocol is not graded; {right}"
                )
            caller = self._callers[run] = InProcess(code, self._provided)
        return caller

    def _code(self) -> Code:
        """The code, loaded when it is first asked for."""
        if self._found is None:
            try:
                self._found = load(self._place)
            except UsageError as error:  # no filter in it
                place, _, wrong = str(error).partition(": ")
                raise FaultError(place, wrong) from None
        return self._found


def _square(P: list[float]) -> Array:
    n = round(len(P) ** 0.5)
    return np.array(P).reshape(n, n)
