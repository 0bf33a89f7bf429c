"""A printed number beside the same number calculated from those that were printed before it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.printed.digits import SLACK
from ekfsim.student.printed.narrative.reading import Number

ROUNDING = 1e-9  # of a number; what is less is what sums make of it
NOTHING = 1e-11  # what is less is printed as 0

Formula = Callable[[Array], float]
Guess = tuple[str, Formula]  # what is told, and the number that the mistake makes


@dataclass(frozen=True, slots=True)
class Wrong:
    """A printed number that is not the one which follows from those before it."""

    line: int
    what: str  # "P_xθ", "the major radius"
    theirs: float
    right: float
    unit: str = ""  # "m", "degrees"
    guess: str = ""  # what explains it, a sentence without a full stop
    read: str = ""  # the equation to read again
    bound: str = ""  # "at most", "at least", where not one number alone is right


@dataclass(frozen=True, slots=True)
class Check:
    """One number to be calculated: how, and what else might have been calculated in its place."""

    what: str
    printed: Number
    formula: Formula  # of the numbers that it follows from
    unit: str = ""
    guesses: tuple[Guess, ...] = ()
    period: float = math.inf  # 360, of headings
    least: float = NOTHING  # a difference of so much is none
    read: str = ""

    def wrong(self, numbers: Sequence[Number]) -> Wrong | None:
        """What is wrong with it, None where it is right as far as the digits go.

        numbers : those that it follows from
        """
        try:
            right = float(self.formula(np.array([one.value for one in numbers])))
            if self._fits(self.formula, numbers):
                return None
        except (ArithmeticError, np.linalg.LinAlgError):  # a number before it is none
            return None
        near = (told for told, formula in self.guesses if self._comes_of(formula, numbers))
        value, line = self.printed.value, self.printed.line
        return Wrong(line, self.what, value, right, self.unit, next(near, ""), self.read)

    def _comes_of(self, formula: Formula, numbers: Sequence[Number]) -> bool:
        """The same of a mistake, which may come to no number."""
        try:
            return self._fits(formula, numbers)
        except (ArithmeticError, np.linalg.LinAlgError):
            return False

    def _fits(self, formula: Formula, numbers: Sequence[Number]) -> bool:
        """Whether the formula leads to what is printed, as far as the digits go."""
        values = np.array([one.value for one in numbers])
        with np.errstate(all="ignore"):
            made = float(formula(values))
            left = self.printed.half + ROUNDING * abs(made) + self.least
            for i, one in enumerate(numbers):
                if one.half:
                    moved = values.copy()
                    moved[i] += one.half
                    left += abs(self._apart(float(formula(moved)) - made))
        if math.isnan(left):
            return not math.isnan(self.printed.value)
        return abs(self._apart(self.printed.value - made)) <= SLACK * left

    def _apart(self, difference: float) -> float:
        return (
            difference if math.isinf(self.period) or not math.isfinite(difference)
            else math.remainder(difference, self.period)
        )  # fmt: skip
