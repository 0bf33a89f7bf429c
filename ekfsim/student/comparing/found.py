"""What is found of a student's filter in a run, or in N of them."""

from collections.abc import Iterable
from dataclasses import dataclass

from ekfsim.records import Control
from ekfsim.student.comparing.compare import Compared
from ekfsim.student.comparing.naming import CLEAN, At, Naming, Seen, textbook
from ekfsim.student.fault import FaultError
from ekfsim.student.mistakes.guessing import Gives, Guess, gives
from ekfsim.student.mistakes.mistake import Mistake


@dataclass(frozen=True, slots=True)
class Found:
    """The first wrong number, what explains it, and all that shows after it."""

    runs: int  # that were begun
    moves: int  # that were compared
    readings: int
    differing: int
    largest: float  # σ, of the steps that do not differ
    first: At | None  # the first step that differs
    guesses: tuple[Guess, ...]  # what explains that, the best first, and those that are as good
    named: dict[Mistake, Seen]  # every mistake that shows anywhere
    unnamed: tuple[Seen, ...]  # steps that nobody could name: moves, then readings
    ended: At | None  # the first step after which no belief was left to go on from
    fault: FaultError | None  # of the student's code, which ended it all
    fault_run: int = 0
    # the first wrong numbers are an EKF's of the models as they are handed out, and the reference
    # is another filter
    textbook: bool = False

    @property
    def steps(self) -> int:
        """That were compared."""
        return self.moves + self.readings

    @property
    def equal(self) -> bool:
        """Whether nothing differs and nothing failed."""
        return self.first is None and self.fault is None


def found(
    runs: Iterable[tuple[int, Iterable[Compared]]], gives: Gives = gives, clean: float = CLEAN
) -> Found:
    """What is found in runs, each with its number. One that fails is the last.

    gives, clean : what is taken for the same number, where not all digits are known
    """
    moves, readings = Naming(gives, clean), Naming(gives, clean)
    begun = steps = read = differing = run = 0
    largest, fault = 0.0, None
    first: At | None = None
    ended: At | None = None
    try:
        for run, compared in runs:
            begun += 1
            for step in compared:
                at = At(run, step)
                is_move = isinstance(step.asked.given, Control)
                (moves if is_move else readings).add(at)
                steps += step.asked.index > 0
                read += step.asked.index > 0 and not is_move
                if step.differences:
                    differing += 1
                    first = first or at
                else:
                    largest = max(largest, step.size)
                if step.unusable:
                    ended = ended or at
    except FaultError as failed:
        fault = failed
    guesses: list[Guess] = []
    if first is not None:
        of = moves if isinstance(first.step.asked.given, Control) else readings
        guesses = of.explanations(first)
    unnamed = tuple(seen for seen in (moves.unnamed(), readings.unnamed()) if seen is not None)
    return Found(
        begun, steps - read, read, differing, largest, first, tuple(guesses),
        moves.named() | readings.named(), unnamed, ended, fault, run,
        first is not None and textbook(first.step, gives),
    )  # fmt: skip
