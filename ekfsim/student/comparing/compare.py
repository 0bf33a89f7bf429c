"""A run under two filters, each step from the belief that the student's code held before it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ekfsim.diagnostics.ambiguity import remark
from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.belief import Correction, Gaussian, Prediction, Refused
from ekfsim.filters.protocol import Filter
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Guard
from ekfsim.student.asked import Answer, Asked, Caller
from ekfsim.student.comparing.difference import DIFFERENT, Difference, differences, sizes
from ekfsim.student.comparing.rounding import rounding


@dataclass(frozen=True, slots=True)
class Compared:
    """What a student's code and the reference made of one motion input or reading."""

    asked: Asked  # from which belief; its index and command say at which step
    theirs: Answer
    right: Gaussian
    size: float  # the largest difference, in σ
    differences: tuple[Difference, ...]  # none where both are equal but for rounding

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
) -> Iterator[Compared]:
    """Each step of a run that is handed to the student's code: one error does not hide the next.

    Raises FaultError where the code fails, or where no belief is left to go on from.
    """
    caller.begin(*first)
    belief, earlier = first, None
    for entry in entries:
        if entry.given is None:
            continue
        asked = Asked(*belief, entry.given, layout.headings, entry.command, entry.index, earlier)
        found = answered(asked, caller, reference, layout, guard)
        if found is None:
            continue
        yield found
        belief, earlier = _believed(found.theirs, layout), asked


def answered(
    asked: Asked, caller: Caller, reference: Filter, layout: Layout, guard: Guard
) -> Compared | None:
    """What both make of one entry; None for a reading that is not handed over."""
    made: Prediction | Correction
    match asked.given:
        case Control(motion, u):
            right, made = reference.predict(Gaussian(asked.x, asked.P), motion, u)
        case Reading(sensor, z):
            right, made = reference.update(Gaussian(asked.x, asked.P), sensor, z)
            if not _handed_over(asked, made, guard):
                return None
    theirs, right = caller.call(asked), Gaussian(*right)
    in_x, in_P = sizes(theirs, right, layout)
    size = float(max(in_x.max(), in_P.max()))
    apart: tuple[Difference, ...] = ()
    if size > DIFFERENT:
        apart = differences(theirs, right, rounding(asked, made), layout)
    return Compared(asked, theirs, right, size, apart)


def _handed_over(asked: Asked, made: Correction, guard: Guard) -> bool:
    """Whether a reading reaches the student's code: it has an echo, a wall, no reason to be
    refused, and something to tell.
    """
    if made.refused != Refused.NOT or np.isnan(made.nis):
        return False
    if guard != "skip":
        return True
    assert isinstance(asked.given, Reading)
    told = remark(asked.given.sensor, asked.x, asked.P)
    return told is None or not told.ambiguous


def _believed(theirs: Answer, layout: Layout) -> Gaussian:
    """The belief that goes on: headings in (−π, π], P symmetric."""
    return Gaussian(wrapped(theirs.x.copy(), layout.headings), symmetric(theirs.P))
