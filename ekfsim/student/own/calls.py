"""The calls of a student's code, in this process."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.own.forms import Functions, Stateful, where
from ekfsim.student.own.handed import Handed, HandedMotion, HandedSensor
from ekfsim.student.own.loading import Code
from ekfsim.student.own.returned import WrongError, answer, looked_at


class InProcess:
    """Calls two functions, or one object of a class after another, here.

    provided : which equations of the models may be asked for; None: all
    """

    def __init__(self, code: Code, provided: Sequence[str] | None = None) -> None:
        assert isinstance(code.form, Functions | Stateful)
        self._code, self._form, self._provided = code, code.form, provided
        self._object: Any = None  # of a class, and the belief that it and we agree on
        self._agreed: tuple[Array, Array] | None = None
        self._turned: Array | float = 0.0  # what its headings have more than ours, full turns

    def begin(self, x: Array, P: Array) -> Answer | None:
        """A run begins with this belief; whatever the code kept of an earlier run is forgotten.

        What an object believes then, should it have both already.
        """
        if isinstance(self._form, Stateful):
            self._object = None
            with self._code.home.entered():
                try:
                    self._object = self._form.kind(x.copy(), P.copy())
                except BaseException as error:
                    self._code.home.blame(error, self._head("__init__"))
            self._agreed, self._turned = (x.copy(), P.copy()), 0.0
            with suppress(AttributeError, WrongError):  # a call may set them yet
                return looked_at(self._object.x, self._object.P, len(x))
        return None

    def call(self, asked: Asked) -> Answer:
        """What the code makes of a motion input or a reading. Raises FaultError."""
        n, given = len(asked.x), asked.given
        handed: Handed = (
            HandedMotion(given.motion, n, self._provided)
            if isinstance(given, Control)
            else HandedSensor(given.sensor, n, self._provided)
        )
        value, step = _value(given), _step(given)
        try:
            if isinstance(self._form, Functions):
                returned = self._run(step, asked.x.copy(), asked.P.copy(), value, handed)
                return answer(returned, step, n)
            self._agree(asked)
            before, self._agreed = self._agreed, None  # it may fail half-way
            return self._told(asked, before, self._run(step, value, handed), step)
        except WrongError as wrong:
            raise FaultError(self.place_of(given), str(wrong)) from None

    def place_of(self, given: Control | Reading) -> str:
        """file:line of the function: of its only return, else of its head."""
        return self._code.place_of(self._called(_step(given)))

    def _run(self, step: str, *args: Any) -> Any:
        function = getattr(self._form if self._object is None else self._object, step)
        with self._code.home.entered():
            try:
                return function(*args)
            except BaseException as error:
                self._code.home.blame(error, self._head(step))

    def _agree(self, asked: Asked) -> None:
        """Set the object's belief where it is not that which is asked from."""
        if self._agreed is None:
            self.begin(asked.x, asked.P)
        elif not all(map(np.array_equal, self._agreed, (asked.x, asked.P))):
            with self._code.home.entered():
                try:
                    self._object.x, self._object.P = asked.x.copy(), asked.P.copy()
                except BaseException as error:
                    self._code.home.blame(error, self._head("__init__"))
            self._turned = 0.0

    def _told(
        self, asked: Asked, before: tuple[Array, Array] | None, returned: Any, step: str
    ) -> Answer:
        """What the object believes now; its headings as far from those asked as it has turned.

        before : its belief then, returned : by its method, whose return is not looked for
        """
        values: list[Any] = []
        for name in ("x", "P"):
            try:
                values.append(getattr(self._object, name))
            except AttributeError:
                kind = type(self._object).__name__
                has = ", ".join(sorted(getattr(self._object, "__dict__", {})))
                right = f"; it has {has}, and a belief is x and P" if has else ""
                raise WrongError(
                    f"{kind} has no attribute '{name}' after the call{right}"
                ) from None
        theirs = looked_at(values[0], values[1], len(asked.x))
        if self._keeps(before, theirs) and _is_another(returned, theirs):
            raise WrongError(
                f"{step} returns what it does not keep; write `self.x, self.P = …` in it"
            )
        # what it has wrapped itself has not turned so far
        apart = np.abs(theirs.x - self._turned - asked.x), np.abs(theirs.x - asked.x)
        x = theirs.x - np.where(apart[0] <= apart[1], self._turned, 0.0)
        wrapped = x.copy()
        for i in asked.headings:
            wrapped[i] = float(np.asarray(wrap(wrapped[i])))
        self._turned = theirs.x - wrapped
        self._agreed = wrapped, theirs.P.copy()
        return Answer(x, theirs.P)

    def _keeps(self, before: tuple[Array, Array] | None, theirs: Answer) -> bool:
        """Whether the object believes what it believed before."""
        if before is None:
            return False
        x, P = before
        return np.array_equal(theirs.x - self._turned, x) and np.array_equal(theirs.P, P)

    def _head(self, step: str) -> str:
        return where(self._called(step)) or self._code.label

    def _called(self, step: str) -> Any:
        return getattr(self._form if isinstance(self._form, Functions) else self._form.kind, step)


def _is_another(returned: Any, theirs: Answer) -> bool:
    """Whether that is a belief, and not the one that is kept."""
    try:
        x, P = (np.asarray(part, float) for part in returned)
    except Exception:
        return False
    return (x.shape, P.shape) == (theirs.x.shape, theirs.P.shape) and not (
        np.array_equal(x, theirs.x) and np.array_equal(P, theirs.P)
    )


def _step(given: Control | Reading) -> str:
    return "predict" if isinstance(given, Control) else "update"


def _value(given: Control | Reading) -> Array:
    return (given.u if isinstance(given, Control) else given.z).copy()
