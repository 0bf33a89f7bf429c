"""A class of one's own of the full protocol of filters: called as it is, and looked after."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import Code
from ekfsim.student.own.returned import WrongError, judged, looked_at

SHAPES = {
    "predicted": "k", "innovation": "k", "R": "kk", "S": "kk", "H": "kn", "K": "nk", "nis": "",
    "refused": "",
}  # fmt: skip


@dataclass(frozen=True)
class WholeFilter:
    """The student's filter; what it believes and what it tells are held against the protocol."""

    remark: ClassVar[str] = ""
    code: Code
    kind: Any  # the student's class
    filter: Any  # and what began of it
    headings: tuple[int, ...]

    @classmethod
    def around(cls, code: Code, form: Whole, beginning: Beginning) -> Self:
        """The filter for a run that begins so. Raises FaultError."""
        whole = cls(code, form.kind, None, beginning.headings)
        return replace(whole, filter=whole._run("begin", whole.kind.begin, beginning))

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Belief, Prediction]:
        """As the student's filter."""
        returned = self._run("predict", self.filter.predict, belief, motion, u)
        after, told = self._two("predict", returned, Prediction, "Prediction(F, G)")
        shapes = {"F": "nn", "G": "nm"}
        self._refuse_misshapen("predict", told, shapes, belief.mean, {"m": len(motion.inputs)})
        return self._believed("predict", belief, after, Control(motion, u)), told

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Belief, Correction]:
        """As the student's filter."""
        returned = self._run("update", self.filter.update, prior, sensor, z, skip)
        fields = ", ".join(SHAPES)
        after, told = self._two("update", returned, Correction, f"Correction({fields})")
        self._refuse_misshapen("update", told, SHAPES, prior.mean, {"k": len(sensor.outputs)})
        return self._believed("update", prior, after, Reading(sensor, z)), told

    def _run(self, step: str, function: Any, *args: Any) -> Any:
        with self.code.home.entered():
            try:
                return function(*args)
            except BaseException as error:
                self.code.home.blame(error, self._place(step))

    def _two(self, step: str, returned: Any, kind: type, right: str) -> Any:
        """A belief and what is told of it. Raises FaultError where it is something else."""
        if isinstance(returned, tuple) and len(returned) == 2 and isinstance(returned[1], kind):
            return returned
        wrong = (
            f"{step} returns no belief and {kind.__name__}; write `return Gaussian(x, P), {right}`"
        )
        raise FaultError(self._place(step), wrong)

    def _refuse_misshapen(
        self, step: str, told: Any, shapes: Mapping[str, str], x: Array, lengths: Mapping[str, int]
    ) -> None:
        """Raise FaultError where what is told of a step is of another shape than the protocol's."""
        *axes, n = x.shape
        sizes = {"n": n, **lengths}
        for name, letters in shapes.items():
            value, shape = getattr(told, name), (*axes, *(sizes[letter] for letter in letters))
            if np.shape(value) != shape or np.asarray(value).dtype.kind not in "iuf":
                wrong = f"{type(told).__name__}.{name} has the shape {np.shape(value)}, not {shape}"
                raise FaultError(self._place(step), wrong)

    def _believed(self, step: str, before: Belief, after: Any, given: Control | Reading) -> Belief:
        """The same belief. Raises FaultError where it can be none."""
        n = before.mean.shape[-1]
        try:
            x, P = after
            if np.shape(x) != before.mean.shape or np.shape(P) != before.covariance.shape:
                raise WrongError(
                    f"x and P have the shapes {np.shape(x)} and {np.shape(P)}, not "
                    f"{before.mean.shape} and {before.covariance.shape}"
                )
            for run in np.ndindex(before.mean.shape[:-1]):
                asked = Asked(before.mean[run], before.covariance[run], given, ())
                judged(asked, looked_at(x[run], P[run], n))
        except WrongError as wrong:
            raise FaultError(self._place(step), str(wrong)) from None
        except (TypeError, ValueError):
            wrong_kind = f"{type(after).__name__} is no belief; write Gaussian(x, P)"
            raise FaultError(self._place(step), wrong_kind) from None
        if isinstance(after, Gaussian) or not hasattr(after, "mean"):
            return Gaussian(wrapped(np.array(x, float), self.headings), np.array(P, float))
        theirs: Belief = after
        return theirs

    def _place(self, step: str) -> str:
        return self.code.place_of(getattr(self.kind, step))
