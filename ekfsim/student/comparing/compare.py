"""A run under two filters, each step from the belief that the student's code held before it."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.diagnostics.ambiguity import remark
from ekfsim.errors import StepError
from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.belief import Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Filter
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Entry, Reading
from ekfsim.scene import Guard
from ekfsim.student.asked import Answer, Asked, Caller
from ekfsim.student.comparing.difference import (
    DIFFERENT,
    Difference,
    differences,
    sizes,
    symbols,
    unit,
)
from ekfsim.student.comparing.reference import made_by
from ekfsim.student.comparing.rounding import LEAST, NONE, deviations, rounding
from ekfsim.student.fault import FaultError
from ekfsim.student.own.returned import WrongError, refuse_boundless

NEGATIVE = 1e-9  # of a variance; so much below 0 it may be by rounding, and the square of `LEAST`


@dataclass(frozen=True, slots=True)
class Compared:
    """What a student's code and the reference made of one motion input or reading."""

    asked: Asked  # from which belief; its index and command say at which step
    theirs: Answer
    right: Gaussian
    size: float  # the largest difference, in σ
    differences: tuple[Difference, ...]  # none where both are equal but for rounding
    unusable: str = ""  # why no belief is left to go on from, where that is so

    @property
    def most(self) -> Difference:
        """The entry that differs most, where one does."""
        return max(self.differences, key=lambda one: one.size)


def compare(
    entries: Iterable[Entry],
    first: Gaussian,
    caller: Caller,
    reference: Filter,
    layout: Layout = POSE,
    guard: Guard = "warn",
    failed: Callable[[Asked, FaultError], None] | None = None,
) -> Iterator[Compared]:
    """Each step of a run that is handed to the student's code: one error does not hide the next.

    Before them comes the start, where the code has begun with another belief than it was given.
    failed : told of each step at which code fails. The run then goes on from what the reference
    believes, as it does after an answer that is no belief. Without it the run ends there, and
    raises FaultError.
    """
    begun, belief = caller.begin(first.mean.copy(), first.covariance.copy()), first
    earlier: Asked | None = None
    for entry in entries:
        if entry.given is None:
            continue
        asked = Asked.at(entry, belief, layout.headings, earlier)
        if begun is not None:
            start, begun = _started(replace(asked, command=None, index=0), begun, layout), None
            if start.differences:
                yield start
                belief = believed(start.theirs, layout)
                asked = replace(asked, x=belief.mean, P=belief.covariance)
        try:
            found = answered(asked, caller, reference, layout, guard)
        except StepError as error:
            fault = error.at(asked.step)
            if failed is None or not isinstance(fault, FaultError):
                raise fault from error.__cause__
            failed(asked, fault)
            belief, earlier = _right(reference, asked)[0], None
            continue
        if found is None:
            continue
        yield found
        if not found.unusable:
            belief, earlier = believed(found.theirs, layout), asked.as_earlier()
        elif failed is None:
            return
        else:
            belief, earlier = found.right, None


def answered(
    asked: Asked, caller: Caller, reference: Filter, layout: Layout, guard: Guard
) -> Compared | None:
    """What both make of one entry; None for a reading that is not handed over: one without an echo,
    without a wall, refused, or with nothing to tell.
    """
    right, made = _right(reference, asked)
    if isinstance(made, Correction) and not (made.used and _passes(asked, guard)):
        return None
    return compared(asked, caller.call(asked), right, made, layout)


def _right(reference: Filter, asked: Asked) -> tuple[Gaussian, Prediction | Correction]:
    """What the reference makes of it. Raises StepError where it is code that fails, too: the fault
    is not the compared code's.
    """
    try:
        return made_by(reference, asked)
    except FaultError as fault:
        raise StepError(f"{fault.at(asked.step)}; it is what the other is held against") from None


def compared(
    asked: Asked, theirs: Answer, right: Gaussian, made: Prediction | Correction | None,
    layout: Layout,
) -> Compared:  # fmt: skip
    """Two answers to what was asked. made : what the reference did to come to its own"""
    in_x, in_P = sizes(theirs, right, layout)
    size = float(max(in_x.max(), in_P.max()))
    if size <= DIFFERENT:
        return Compared(asked, theirs, right, size, ())
    allowed = NONE if made is None else rounding(asked, made, right.covariance)
    apart = differences(theirs, right, allowed, layout)
    unusable = _unusable(theirs, asked, right, layout) if apart else ""
    return Compared(asked, theirs, right, size, apart, unusable)


def believed(theirs: Answer, layout: Layout) -> Gaussian:
    """The belief that goes on: headings in (−π, π], P symmetric."""
    return Gaussian(wrapped(theirs.x.copy(), layout.headings), symmetric(theirs.P))


def _started(asked: Asked, begun: Answer, layout: Layout) -> Compared:
    """The belief that the code begins with beside the one that it was given."""
    return compared(asked, begun, Gaussian(asked.x, asked.P), None, layout)


def _passes(asked: Asked, guard: Guard) -> bool:
    """Whether the guard lets a reading through."""
    if guard != "skip" or not isinstance(asked.given, Reading):
        return True
    told = remark(asked.given.sensor, asked.x, asked.P)
    return told is None or not told.ambiguous


def _unusable(theirs: Answer, asked: Asked, right: Gaussian, layout: Layout) -> str:
    """Why an answer cannot be a belief, "" where it can."""
    try:
        refuse_boundless(theirs.x, theirs.P)
    except WrongError as wrong:
        return str(wrong)
    σ = np.maximum(deviations(asked.P), unit(right))
    slight = np.sqrt(NEGATIVE * np.square(σ) + LEAST**2)
    if float(np.linalg.eigvalsh(symmetric(theirs.P) / np.outer(slight, slight))[0]) >= -1:
        return ""
    for name, variance, s in zip(
        symbols(layout), theirs.P.diagonal().tolist(), slight, strict=True
    ):
        if variance < -s * s:
            return f"its variance of {name} is {variance:.6g}, and no variance is negative"
    return "its P has a negative eigenvalue, and is no covariance"
