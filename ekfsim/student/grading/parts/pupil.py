"""Who calls the student's code while a test runs: a process of its own, or, in tests, this one."""

from collections.abc import Iterator
from typing import Protocol

from ekfsim.geometry import Array
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Caller, Calls


class Pupil(Caller, Protocol):
    """A caller that serves runs side by side, too, and asks for the student's own derivatives."""

    def new_caller(self) -> Caller:
        """One more caller of the same code, for a run beside others."""

    def together(self, calls: Calls) -> Iterator[Answer]:
        """What comes of calls of its callers, asked at once. Raises FaultError where one fails."""

    def derivative(self, name: str, x: Array, given: Control | Reading) -> Array:
        """What the student's F, G or H makes of a motion input or a sensor. Raises FaultError."""
