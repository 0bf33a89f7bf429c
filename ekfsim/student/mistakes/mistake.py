"""A mistake: what is told of it, what to read again, and what it changes in a step."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.working import Pieces, Working, usable

Where = Callable[[Asked], bool]
Fitted = Callable[[Asked, Answer], Iterable[Pieces]]


def _known_beforehand(_: Asked, __: Answer) -> Iterable[Pieces]:
    return ()


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake as students make it; there may be several ways of writing it down."""

    name: str
    told: str  # a sentence to the student, in the assignment's names
    read: str  # the equation to read again
    where: Where  # the steps in which it can be made
    ways: tuple[Pieces, ...]  # what it puts in the place of which symbols; the usual way first
    # more ways, where what is put there can only be known from a student's numbers
    fitted: Fitted = _known_beforehand

    @property
    def general(self) -> bool:
        """Whether it fits itself to numbers, and so explains what a plainer mistake explains."""
        return self.fitted is not _known_beforehand

    def applied(self, asked: Asked) -> Gaussian | None:
        """What a filter with this mistake alone makes of the step; None where it cannot be made."""
        return outcome(asked, self.ways[0]) if self.where(asked) and usable(asked) else None


def outcome(asked: Asked, *changes: Pieces) -> Gaussian | None:
    """The belief after a step with these changes; None where no number comes of it."""
    with np.errstate(all="ignore"):
        x, P = Working(asked, *changes).result
    return Gaussian(x, P) if np.isfinite(x).all() and np.isfinite(P).all() else None


ELSEWHERE = {"J_x": "F", "J_u": "G", "P_u": "M", "J_H": "H", "C_v": "R", "Φ": "f"}


def elsewhere(text: str) -> str:
    """`told` or `read` where the assignment's names and equations are not known.

    >>> elsewhere("eqs 6, 7: J_x is taken at the estimate before the move")
    'F is taken at the estimate before the move'
    """
    text = re.sub(r"^eqs? [\d, ]+(to \d+)?: ", "", text)
    return re.sub(r"J_x|J_u|P_u|J_H|C_v|Φ", lambda name: ELSEWHERE[name[0]], text)
