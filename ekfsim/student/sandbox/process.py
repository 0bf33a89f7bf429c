"""The process that a student's code runs in: begun, asked by a deadline, ended.

Nothing that comes of it is waited for without a deadline, kept without a bound, or believed.
"""

import contextlib
import dataclasses
import json
import os
import secrets
import select
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import ekfsim
from ekfsim.errors import RunError, UsageError
from ekfsim.printable import in_a_line, short
from ekfsim.student.fault import FaultError
from ekfsim.student.sandbox.exchange import (
    FAULT,
    HEAD,
    MOST,
    NUMBERS,
    REQUEST,
    Message,
    fault_of,
    packed,
)
from ekfsim.student.sandbox.keeper import KILLING, MOST_LEFT, TOO_MANY, descendants
from ekfsim.student.sandbox.limits import ALONE, Limits

STARTING = 120.0  # s in which Python and NumPy have started even on a busy machine
GRACE = 2.0  # s beyond its time in which it can still say where it was, or how it has ended
CHUNK = 2**16
MOST_PARTS = 64  # of what it has printed when it is not waited for
FORGED = "writes to the exchange itself; only what a function returns counts"
START = """\
import json, sys
asked = json.loads(sys.argv[1])
at = next((i for i, path in enumerate(sys.path) if path.endswith("-packages")), len(sys.path))
sys.path[at:at] = asked["paths"]
from ekfsim.student.sandbox.keeper import main
main(asked)
"""
Question = tuple[str, Sequence[Any]]  # what, of what
PACKAGES = [Path(module.__file__ or "").parent for module in (ekfsim, np)]


class Process:
    """A process with a student's code, from its start to its end.

    through : words of a command that it is begun through, such as ("sudo", "-u", "nobody"); where
    the last is a python, it is that which is begun
    """

    def __init__(
        self, place: str, folder: Path, provided: Sequence[str] | None, limits: Limits,
        through: Sequence[str],
    ) -> None:  # fmt: skip
        self._label, self._limits, self._left = os.path.basename(place), limits, STARTING
        self.ended = self._closed = False
        self.left = 0  # processes that were still running when it was ended
        self._came = bytearray()  # of the exchange, not yet read
        self._kept, self._printed = bytearray(), 0
        asked = {
            "place": place, "folder": str(folder), "provided": provided,
            "paths": [str(package.parent) for package in PACKAGES],
            "read": list(map(str, map(_installed, PACKAGES))),
            "limits": dataclasses.asdict(limits),
        }  # fmt: skip
        self._process = _begun(through, folder, json.dumps(asked))
        pipes = self._process.stdin, self._process.stdout, self._process.stderr
        self._requests, self._answers, self._prints = (pipe.fileno() for pipe in pipes if pipe)
        self._wait = select.poll()
        for pipe in (self._requests, self._answers, self._prints):
            os.set_blocking(pipe, False)
        for pipe in (self._answers, self._prints):
            self._wait.register(pipe, select.POLLIN)
        try:
            _, self.fenced = map(int, np.frombuffer(self.ask("hello")))
        except FaultError as fault:  # none of the student's: the code has not been read yet
            wrong = fault.wrong if self._left > 0 else f"did not start within {STARTING:g} s"
            told = short(in_a_line(" ".join(self.printed[0].split()[-30:])), 200)
            begun = f"the process for a student's code, through {' '.join(through) or 'nothing'}"
            raise RunError(f"{begun}: {wrong}{told and f'; it says: {told}'}") from None
        except BaseException:
            self.end()
            raise
        self._left = limits.wall_seconds

    def ask(self, what: str, *told: Any, kind: int = NUMBERS) -> bytes:
        """What it answers, of that kind. Raises FaultError for whatever else comes of it."""
        contents, fault = self.ask_all([(what, told)], kind)
        if fault is not None:
            raise fault
        return contents[0]

    def ask_all(
        self, questions: Sequence[Question], kind: int = NUMBERS
    ) -> tuple[list[bytes], FaultError | None]:
        """What it answers to each question, of that kind, up to whatever else comes of one."""
        contents: list[bytes] = []
        mark, began = secrets.token_bytes(8), time.monotonic()
        try:
            if self._left <= 0:
                raise self.refused(self._limits.too_long)
            request = json.dumps([self._left, questions]).encode()
            self._send(packed(Message(REQUEST, mark, request)), began)
            for _ in questions:
                contents.append(self._content(self._answer(mark, began), kind))
        except FaultError as fault:
            return contents, fault
        finally:
            self._left -= time.monotonic() - began
        return contents, None

    def _content(self, answer: Message, kind: int) -> bytes:
        """What an answer holds, if it is of that kind. Raises FaultError."""
        if answer.kind == FAULT:
            place, wrong = fault_of(answer.content)
            if wrong in (self._limits.too_long, self._limits.too_busy):
                self.end()
            raise FaultError(place, wrong)
        if answer.kind != kind:
            raise self.refused(FORGED)
        return answer.content

    def _send(self, message: bytes, began: float) -> None:
        """Hand it a request as fast as it takes it."""
        while message:
            try:
                message = message[os.write(self._requests, message) :]
                continue
            except BrokenPipeError:
                raise self._lost() from None
            except BlockingIOError:
                self._wait.register(self._requests, select.POLLOUT)
            self._take(self._remaining(began))
            self._wait.unregister(self._requests)
            if self._came:  # before it has been asked
                raise self.refused(FORGED)

    def _answer(self, mark: bytes, began: float) -> Message:
        """Its answer, if it is one."""
        while True:
            if len(self._came) >= HEAD.size:
                length, kind, theirs = HEAD.unpack_from(self._came)
                if theirs != mark or length > MOST.get(kind, -1):
                    raise self.refused(FORGED)
                end = HEAD.size + length
                if len(self._came) >= end:
                    content = bytes(self._came[HEAD.size : end])
                    del self._came[:end]
                    return Message(kind, mark, content)
            if self._closed:
                raise self._lost()
            self._take(self._remaining(began))

    def _remaining(self, began: float) -> float:
        """Seconds that are left to it. Raises FaultError where there are none."""
        left = self._left + GRACE - (time.monotonic() - began)
        if left <= 0:
            raise self.refused(self._limits.too_long)
        return left

    def _take(self, seconds: float) -> None:
        """Wait for what it writes or prints, and take it in."""
        for pipe, _ in self._wait.poll(seconds * 1000):
            if pipe == self._requests:
                continue
            try:
                part = os.read(pipe, CHUNK)
            except BlockingIOError:
                continue
            if not part:
                self._wait.unregister(pipe)
            if pipe == self._prints:
                self._printed += len(part)
                self._kept += part[: max(0, 4 * self._limits.printed - len(self._kept))]
                continue
            self._came += part  # not much: what is no answer is refused as soon as it is seen
            self._closed |= not part

    def _take_prints(self) -> None:
        """Take in what it has printed, as far as that is not without end."""
        for _ in range(0 if self.ended else MOST_PARTS):
            before = self._printed
            self._take(0)
            if self._printed == before:
                return

    def refused(self, wrong: str) -> FaultError:
        """What it did is no answer: it is ended, and not asked again."""
        self.end()
        return FaultError(self._label, wrong)

    def _lost(self) -> FaultError:
        """It has ended, or closed the exchange, where it should have answered."""
        try:
            status = self._process.wait(GRACE)
        except subprocess.TimeoutExpired:
            return self.refused("closed the exchange instead of answering")
        limits = self._limits
        if status == TOO_MANY:
            wrong = f"started more than {limits.processes} processes"
        elif status in (128 + signal.SIGXCPU, 128 + signal.SIGPROF):
            wrong = limits.too_busy
        elif status == 128 + signal.SIGKILL:
            wrong = "was killed: by itself, or for want of memory"
        elif status > 128:
            wrong = f"crashed: {signal.strsignal(status - 128)}"
        elif status < 0:
            wrong = "killed the process that watches over it"
        else:
            wrong = f"ended its process with status {status} instead of answering"
        return self.refused(wrong)

    @property
    def printed(self) -> tuple[str, int]:
        """The beginning of what it printed, and how many bytes there were in all."""
        self._take_prints()
        return self._kept.decode(errors="replace"), self._printed

    def end(self) -> None:
        """Kill it, and all that it started."""
        if self.ended:
            return
        self._take_prints()
        self.ended, process = True, self._process
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()
        with contextlib.suppress(ProcessLookupError, PermissionError):
            process.send_signal(signal.SIGCONT)  # the code may have stopped it
            process.terminate()
        try:
            status = process.wait(KILLING + 1)
            self.left = status if 0 < status <= MOST_LEFT and not self._closed else 0
        except subprocess.TimeoutExpired:  # the keeper has been stopped, or cannot kill
            for one in (*descendants(process.pid), process.pid):
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.kill(one, signal.SIGKILL)
            process.wait(1)


def _begun(through: Sequence[str], folder: Path, asked: str) -> "subprocess.Popen[bytes]":
    """The process, or what it is begun through. Raises UsageError where there is no such thing."""
    alone = dict.fromkeys(ALONE, "1")
    command = [sys.executable, "-I", "-X", "utf8", "-c", START, asked]
    words = [word.replace("{folder}", str(folder)) for word in through]
    if words and os.path.basename(words[-1]).startswith("python"):
        command[0:1] = words
    elif words:
        command[0:0] = [*words, "env", "-i", *(f"{name}={value}" for name, value in alone.items())]
    try:
        return subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            cwd=folder, env=None if through else alone, start_new_session=True, bufsize=0,
        )  # fmt: skip
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise UsageError(f"{in_a_line(command[0])}: cannot be started: {reason}") from None


def _installed(package: Path) -> Path:
    """What is read where a package stands: all that is installed beside it, else itself."""
    return package.parent if package.parent.name.endswith("-packages") else package
