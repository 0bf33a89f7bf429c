"""A caller whose student's code runs in a process of its own."""

import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.printable import in_a_line, short, shown
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked, Caller, Calls
from ekfsim.student.fault import FaultError
from ekfsim.student.sandbox.exchange import NUMBERS, WORDS
from ekfsim.student.sandbox.folder import copy_of, remove
from ekfsim.student.sandbox.kernel import lacking
from ekfsim.student.sandbox.limits import Limits
from ekfsim.student.sandbox.process import Process, Question
from ekfsim.student.sandbox.told import Teller

AT_ONCE = 64  # calls; each wait for an answer is a turn of the machine's
MOST_PLACE, MOST_WORDS = 100, 400  # characters of where and of what is wrong


class Sandboxed:
    """Calls a student's code in a process of its own, begun when it is first needed.

    A fault of the code leaves the process alive; one that ended it, or took too long, is raised
    again by every later call. To be closed, or used in a `with`.

        submission   a file, or a folder; it is copied, and never touched
        file         in a folder, the file with the code
        name         of a class in it, "" for the one that is there
        provided     which equations of the models may be asked for; None: all
        through      words of a command that the process is begun through; see docs/course/safety.md
    """

    def __init__(
        self,
        submission: Path,
        file: str = "",
        name: str = "",
        provided: Sequence[str] | None = None,
        limits: Limits = Limits(),  # noqa: B008  frozen
        through: Sequence[str] = (),
    ) -> None:
        if os.name != "posix":
            raise UsageError(
                "a student's code is kept to no limits on this system; grade on Linux or macOS, "
                "on Windows in WSL"
            )
        self._submission, self._provided = submission, provided
        self._file = (file or submission.name) + (f":{name}" if name else "")
        self._limits, self._through = limits, through
        self.teller = Teller()
        self._folder: Path | None = None
        self._process: Process | None = None
        self._fatal: tuple[str, str] | None = None
        self._runs = 0
        self._own = self.new_caller()

    def new_caller(self) -> Caller:
        """One more caller of the same process, for a run beside others."""
        self._runs += 1
        return _Run(self, self._runs - 1)

    def begin(self, x: Array, P: Array) -> Answer | None:
        """A run begins with this belief; whatever the code kept of an earlier run is forgotten."""
        return self._own.begin(x, P)

    def call(self, asked: Asked) -> Answer:
        """What the code makes of a motion input or a reading. Raises FaultError."""
        return self._own.call(asked)

    def place_of(self, given: Control | Reading) -> str:
        """file:line of the code that answers to it."""
        return self._own.place_of(given)

    def together(self, calls: Calls) -> Iterator[Answer]:
        """What comes of calls of its callers, many of them asked at once. Raises FaultError where
        one fails.
        """
        for first in range(0, len(calls), AT_ONCE):
            some = calls[first : first + AT_ONCE]
            questions: list[Question] = []
            for one, asked in some:
                assert isinstance(one, _Run)
                questions.append(one.question(asked))
            contents, fault = self._ask_all(questions, NUMBERS)
            for (_, asked), content in zip(some, contents, strict=False):
                n = len(asked.x)
                yield _answer(self._finite(content, (n + n * n,)), n)
            if fault is not None:
                self.teller = Teller()  # of what was told after it nothing was heard
                raise fault

    def derivative(self, name: str, x: Array, given: Control | Reading) -> Array:
        """What the student's own function F, G or H returns. Raises FaultError."""
        n, told = len(x), self.teller.told(given)
        inputs = len(told[2])
        rows, columns = {"F": (n, n), "G": (n, inputs), "H": (inputs, n)}[name]
        numbers = self.numbers((rows * columns,), "derivative", name, x.tolist(), told)
        return numbers.reshape(rows, columns)

    @property
    def printed(self) -> str:
        """What it printed, made harmless; of much only the beginning."""
        if self._process is None:
            return ""
        text, size = self._process.printed
        kept = text[: self._limits.printed]
        more = size - len(kept.encode())
        return shown(kept) + (f"… and {more} bytes more" if more > 0 else "")

    @property
    def left(self) -> int:
        """How many processes it had left running when it was closed; they were killed."""
        return 0 if self._process is None else self._process.left

    @property
    def lacks(self) -> tuple[str, ...]:
        """What it is not kept from on this machine; see docs/course/safety.md."""
        return lacking((self._process or self._begun()).fenced)

    def close(self) -> None:
        """End the process and all that it started, and delete its folder."""
        if self._process is not None:
            self._process.end()
        if self._folder is not None:
            remove(self._folder)
            self._folder = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def numbers(self, allowed: tuple[int, ...], what: str, *told: Any) -> Array:
        """Finite numbers that it answers, as many as is allowed. Raises FaultError."""
        return self._finite(self._ask(NUMBERS, what, *told), allowed)

    def _finite(self, content: bytes, allowed: tuple[int, ...]) -> Array:
        numbers = np.frombuffer(content[: len(content) // 8 * 8], "<f8").copy()
        if len(content) // 8 in allowed and all(map(math.isfinite, numbers.tolist())):
            return numbers
        assert self._process is not None
        raise self._told(self._process.refused("answers something else than was asked"))

    def words(self, what: str, *told: Any) -> str:
        """Words that it answers, as they stand in a line. Raises FaultError."""
        answer = self._ask(WORDS, what, *told).decode(errors="replace")
        return short(in_a_line(answer), MOST_PLACE)

    def _ask(self, kind: int, what: str, *told: Any) -> bytes:
        contents, fault = self._ask_all([(what, told)], kind)
        if fault is not None:
            raise fault
        return contents[0]

    def _ask_all(
        self, questions: Sequence[Question], kind: int
    ) -> tuple[list[bytes], FaultError | None]:
        """What it answers, and what came of it where that is less than was asked."""
        if self._fatal is not None:
            return [], FaultError(*self._fatal)
        try:
            process = self._process or self._begun()
        except FaultError as fault:
            return [], self._told(fault)
        contents, failed = process.ask_all(questions, kind)
        return contents, None if failed is None else self._told(failed)

    def _begun(self) -> Process:
        self._folder = copy_of(self._submission, shared=bool(self._through))
        place = str(self._folder / self._file)
        self._process = Process(place, self._folder, self._provided, self._limits, self._through)
        return self._process

    def _told(self, fault: FaultError) -> FaultError:
        """The same fault, whatever its words hold; kept, where the process has ended by it."""
        place = short(in_a_line(fault.place), MOST_PLACE)
        wrong = short(in_a_line(fault.wrong), MOST_WORDS)
        if self._process is None or self._process.ended:
            self._fatal = place, wrong
        return FaultError(place, wrong)


class _Run:
    """One run after another of the code in a process that has others beside it."""

    def __init__(self, sandbox: Sandboxed, number: int) -> None:
        self._sandbox, self._number = sandbox, number

    def begin(self, x: Array, P: Array) -> Answer | None:
        """A run begins with this belief."""
        numbers = self._sandbox.numbers(
            (0, x.size + P.size), "begin", self._number, x.tolist(), P.ravel().tolist()
        )
        return _answer(numbers, len(x)) if len(numbers) else None

    def call(self, asked: Asked) -> Answer:
        """What the code makes of a motion input or a reading."""
        n, (what, told) = len(asked.x), self.question(asked)
        return _answer(self._sandbox.numbers((n + n * n,), what, *told), n)

    def question(self, asked: Asked) -> Question:
        """The same call as it is told to the process."""
        given = self._sandbox.teller.told(asked.given)
        x, P = asked.x.tolist(), asked.P.ravel().tolist()
        return "call", (self._number, x, P, given, asked.headings)

    def place_of(self, given: Control | Reading) -> str:
        """file:line of the code that answers to it."""
        return self._sandbox.words("place_of", self._sandbox.teller.told(given))


def _answer(numbers: Array, n: int) -> Answer:
    return Answer(numbers[:n], numbers[n:].reshape(n, n))
