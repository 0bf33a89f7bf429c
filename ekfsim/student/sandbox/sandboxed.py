"""A caller whose student's code runs in a process of its own."""

import math
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from ekfsim.geometry import Array
from ekfsim.printable import in_a_line, short, shown
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.sandbox.folder import copy_of, remove
from ekfsim.student.sandbox.limits import Limits
from ekfsim.student.sandbox.process import Process
from ekfsim.student.sandbox.told import Teller

MOST_PLACE, MOST_WORDS = 100, 400  # characters of where and of what is wrong


class Sandboxed:
    """Calls a student's code in a process of its own, begun when it is first needed.

    A fault of the code leaves the process alive; one that ended it, or took too long, is raised
    again by every later call. To be closed, or used in a `with`.

        submission   his file, or his folder; it is copied, and never touched
        file         in a folder, the file with the code
        name         of a class in it, "" for the one that is there
        provided     which equations of the models may be asked for; None: all
        through      words of a command that the process is begun through; see docs/safety.md
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
        self._submission, self._provided = submission, provided
        self._file = (file or submission.name) + (f":{name}" if name else "")
        self._limits, self._through = limits, through
        self._teller = Teller()
        self._folder: Path | None = None
        self._process: Process | None = None
        self._fatal: tuple[str, str] | None = None

    def begin(self, x: Array, P: Array) -> None:
        """A run begins with this belief; whatever the code kept of an earlier run is forgotten."""
        self._ask("begin", x.tolist(), P.ravel().tolist())

    def call(self, asked: Asked) -> Answer:
        """What the code makes of a motion input or a reading. Raises FaultError."""
        n = len(asked.x)
        match asked.given:
            case Control(motion, u):
                slot, value, moves = self._teller.slot(motion), u, True
            case Reading(sensor, z):
                slot, value, moves = self._teller.slot(sensor), z, False
        content = self._ask(
            "call", self._teller.new(), slot, asked.x.tolist(), asked.P.ravel().tolist(),
            value.tolist(), asked.headings, moves,
        )  # fmt: skip
        if len(content) != 8 * (n + n * n):
            raise self._refused("answers with another number of numbers than was asked for")
        numbers = np.frombuffer(content, "<f8")
        if not all(map(math.isfinite, numbers.tolist())):
            raise self._refused("answers with what is no finite number")
        return Answer(numbers[:n].copy(), numbers[n:].reshape(n, n).copy())

    @property
    def printed(self) -> str:
        """What it printed, made harmless; of much only the beginning."""
        if self._process is None:
            return ""
        text, size = self._process.printed
        kept = text[: self._limits.printed]
        more = size - len(kept.encode(errors="replace"))
        return shown(kept) + (f"… and {more} bytes more" if more > 0 else "")

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

    def _ask(self, what: str, *told: Any) -> bytes:
        """The numbers that it answers. Raises FaultError."""
        if self._fatal is not None:
            raise FaultError(*self._fatal)
        process = self._process or self._begun()
        try:
            return process.ask(what, *told)
        except FaultError as fault:
            raise self._told(fault) from None

    def _begun(self) -> Process:
        self._folder = copy_of(self._submission)
        place = str(self._folder / self._file)
        self._process = Process(place, self._folder, self._provided, self._limits, self._through)
        return self._process

    def _refused(self, wrong: str) -> FaultError:
        """What it answered cannot be used, and was not made by our side of it."""
        assert self._process is not None
        return self._told(self._process.refused(wrong))

    def _told(self, fault: FaultError) -> FaultError:
        """The same fault, whatever its words hold; kept, where the process has ended by it."""
        place, wrong = (
            short(in_a_line(text), most)
            for text, most in ((fault.place, MOST_PLACE), (fault.wrong, MOST_WORDS))
        )
        if self._process is not None and self._process.ended:
            self._fatal = place, wrong
        return FaultError(place, wrong)
