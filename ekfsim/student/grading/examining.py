"""One test of one submission, from what is asked to points and words.

Whatever goes wrong here costs that test alone: a failure of ours is told as ours, not a student's.
"""

import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from types import FrameType

from ekfsim.errors import EkfsimError
from ekfsim.files.homework import Homework
from ekfsim.files.keys.homework import (
    HonestyKeys,
    InputsKeys,
    JacobiansKeys,
    PartKeys,
    StepsKeys,
)
from ekfsim.printable import in_a_line, short
from ekfsim.student.fault import FaultError
from ekfsim.student.grading.bench import Bench
from ekfsim.student.grading.parts.honesty import graded_honesty
from ekfsim.student.grading.parts.inputs import graded_inputs
from ekfsim.student.grading.parts.jacobians import graded_jacobian
from ekfsim.student.grading.parts.steps import graded_steps
from ekfsim.student.grading.scores import Check, Scored, checks_of
from ekfsim.student.grading.submissions import Submission
from ekfsim.student.sandbox.limits import Limits, TimeOverError, patience
from ekfsim.student.sandbox.sandboxed import Sandboxed

MOST_PRINTED = 300  # characters of what the code printed that are told


@dataclass
class Examiner:
    """Grades the tests of a homework, one after another."""

    homework: Homework
    through: tuple[str, ...] = ()  # a command that the students' code is begun through
    bench: Bench = field(init=False)
    checks: tuple[Check, ...] = field(init=False)

    def __post_init__(self) -> None:
        self.bench = Bench(self.homework)
        self.checks = checks_of(self.homework.keys)

    def examine(self, check: Check, submission: Submission) -> Scored:
        """What becomes of a test. Raises nothing: what fails here is told in it."""
        score = Scored(check)
        try:
            return self._examined(score, submission)
        except FaultError as fault:  # of a kind that no part expects
            return score.failed(str(fault), str(fault))
        except MemoryError:
            return score.lost("not judged: the grader had too little memory")
        except (EkfsimError, Exception) as error:
            told = short(in_a_line(f"{type(error).__name__}: {error}"), 300)
            return score.lost(f"not judged: the grader itself failed: {told}")

    def _examined(self, score: Scored, submission: Submission) -> Scored:
        keys = _keys_of(self.homework, score.check)
        seconds = self.homework.keys.limits.seconds
        if isinstance(keys, InputsKeys):
            try:
                with at_most(seconds):
                    return graded_inputs(score, keys, submission.path)
            except TimeOverError:
                told = f"the files take longer than {seconds:g} s of CPU to read and to play"
                return score.failed(told, told)
        file, missing = submission.filter(self.homework.keys.filter)
        if missing:
            return score.failed(missing, missing)
        with self._sandboxed(submission, file) as pupil:
            match keys:
                case StepsKeys():
                    score = graded_steps(score, keys, self.bench, pupil)
                case JacobiansKeys():
                    score = graded_jacobian(score, keys, self.bench, pupil)
                case HonestyKeys():
                    score = graded_honesty(score, keys, self.bench, pupil)
        beside = *_printed(pupil.printed), *_left(pupil.left)
        return replace(score, words=(*score.words, *beside))

    def _sandboxed(self, submission: Submission, file: str) -> Sandboxed:
        asked = self.homework.keys.limits
        limits = Limits(asked.seconds, patience(asked.seconds), asked.memory)
        provided = self.homework.keys.provided
        file = "" if submission.path.name == file else file
        return Sandboxed(
            submission.path, file, provided=provided, limits=limits, through=self.through
        )


def _printed(text: str) -> Sequence[str]:
    """What the code printed, a line of it; it costs nothing and earns nothing."""
    told = " ".join(text.split())
    return [f"it printed: {short(told, MOST_PRINTED)}"] if told else []


def _left(processes: int) -> Sequence[str]:
    """What the code had not ended itself, a line of it; it costs nothing either."""
    if not processes:
        return []
    told = "a process" if processes == 1 else f"{processes} processes"
    return [f"it left {told} running, which the grader ended"]


def _keys_of(homework: Homework, check: Check) -> PartKeys:
    """What the part asks for that a test is of."""
    return homework.keys.parts[int(check.number.partition(".")[0]) - 1].asks_for


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Raise TimeOverError where this process calculates longer in the block; of its main thread
    alone.
    """

    def end(number: int, frame: FrameType | None) -> None:
        raise TimeOverError

    before = signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
