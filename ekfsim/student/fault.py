"""What is wrong with a student's code, in a line."""

from typing import Self

from ekfsim.errors import StepError


class FaultError(StepError):
    """A student's code that failed: an exception, a wrong shape, nan; status 1.

    One line, `mine.py:12: step 7 (sense 90°): what is wrong; what would be right`.
    """

    def __init__(self, place: str, wrong: str, step: str = "") -> None:
        super().__init__(f"{place}: {step}: {wrong}" if step else f"{place}: {wrong}")
        self.place, self.wrong, self.step = place, wrong, step

    def __reduce__(self) -> tuple[type[Self], tuple[str, str, str]]:
        """Packed by its own words alone: what it came of may be of a student's class."""
        return type(self), (self.place, self.wrong, self.step)

    def at(self, step: str) -> Self:
        """The same fault, where the step is known at which it came."""
        return type(self)(self.place, self.wrong, self.step or step)
