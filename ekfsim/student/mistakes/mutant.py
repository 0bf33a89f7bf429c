"""A filter with one of the known mistakes, and no other."""

from dataclasses import dataclass

from ekfsim.geometry import Array
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.working import right


@dataclass(frozen=True)
class Mutant:
    """Answers as a student's code with this mistake would; a `Caller`."""

    mistake: Mistake

    def begin(self, x: Array, P: Array) -> None:
        """It keeps no belief of its own."""

    def call(self, asked: Asked) -> Answer:
        """The EKF's step with the mistake, where it can be made."""
        belief = self.mistake.applied(asked)
        return Answer(*(right(asked) if belief is None else belief))

    def place_of(self, given: Control | Reading) -> str:
        """No file."""
        return self.mistake.name
