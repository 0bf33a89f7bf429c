"""What is wrong with a student's code, in a line."""

from typing import Self

from ekfsim.errors import StepError


class FaultError(StepError):
    """A student's code that failed: an exception, a wrong shape, nan; status 1.

    One line, `mine.py:12: step 7 (sense 90°): what is wrong; what would be right`; of many runs
    `mine.py:12: run 1037, step 7 (sense 90°): …`.
    """

    def __init__(self, place: str, wrong: str, step: str = "", run: int | None = None) -> None:
        where = ", ".join(filter(None, ("" if run is None else f"run {run}", step)))
        super().__init__(": ".join(filter(None, (place, where, wrong))))
        self.place, self.wrong, self.step, self.run = place, wrong, step, run

    def __reduce__(self) -> tuple[type[Self], tuple[str, str, str, int | None]]:
        """Packed by its own words alone: what it came of may be of a student's class."""
        return type(self), (self.place, self.wrong, self.step, self.run)

    def at(self, step: str) -> Self:
        """The same fault, where the step is known at which it came."""
        return type(self)(self.place, self.wrong, self.step or step, self.run)

    def in_run(self, run: int) -> Self:
        """The same fault, where it is known in which of many runs it came."""
        return type(self)(self.place, self.wrong, self.step, run)
