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
from ekfsim.student.fault import FaultError
from ekfsim.student.sandbox.exchange import (
    ANSWER,
    FAULT,
    HEAD,
    MOST_NUMBERS,
    MOST_WORDS,
    REQUEST,
    Message,
    fault_of,
    packed,
)
from ekfsim.student.sandbox.keeper import TOO_MANY
from ekfsim.student.sandbox.limits import ALONE, Limits

GRACE = 0.25  # s beyond its time in which it can still say where it was
ENDING = 2.0  # s in which the keeper ends what there is
CHUNK = 2**16
START = """\
import json, sys
asked = json.loads(sys.argv[1])
at = next((i for i, path in enumerate(sys.path) if path.endswith("-packages")), len(sys.path))
sys.path[at:at] = asked["paths"]
from ekfsim.student.sandbox.keeper import main
main(asked)
"""
PATHS = [str(Path(module.__file__ or "").parents[1]) for module in (ekfsim, np)]


class Process:
    """A process with a student's code, from its start to its end.

    through : words of a command that it is begun through, such as ("sudo", "-u", "nobody")
    """

    def __init__(
        self, place: str, folder: Path, provided: Sequence[str] | None, limits: Limits,
        through: Sequence[str] = (),
    ) -> None:  # fmt: skip
        self._label, self._limits, self._left = os.path.basename(place), limits, limits.seconds
        self.ended = False
        self._came = bytearray()  # of the exchange, not yet read
        self._kept, self._printed = bytearray(), 0
        asked = {
            "place": place, "folder": str(folder), "provided": provided, "paths": PATHS,
            "limits": dataclasses.asdict(limits),
        }  # fmt: skip
        self._process = subprocess.Popen(
            [*through, sys.executable, "-I", "-X", "utf8", "-c", START, json.dumps(asked)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            cwd=folder, env=dict.fromkeys(ALONE, "1"), start_new_session=True, bufsize=0,
        )  # fmt: skip
        pipes = self._process.stdin, self._process.stdout, self._process.stderr
        self._requests, self._answers, self._prints = (pipe.fileno() for pipe in pipes if pipe)
        for pipe in (self._requests, self._answers, self._prints):
            os.set_blocking(pipe, False)
        self._wait = select.poll()
        self._wait.register(self._answers, select.POLLIN)
        self._wait.register(self._prints, select.POLLIN)

    def ask(self, what: str, *told: Any) -> bytes:
        """The numbers that it answers. Raises FaultError for whatever else comes of it."""
        began = time.monotonic()
        self._take(0)
        if self._came:
            raise self.refused("answers before it was asked")
        mark = secrets.token_bytes(8)
        request = json.dumps([self._left, what, told]).encode()
        try:
            self._send(packed(Message(REQUEST, mark, request)), began)
            answer = self._answer(mark, began)
        finally:
            self._left -= time.monotonic() - began
        if answer.kind == FAULT:
            if self._left <= 0:
                self.end()
            raise FaultError(*fault_of(answer.content))
        return answer.content

    def _send(self, message: bytes, began: float) -> None:
        """Hand it a request as fast as it takes it."""
        self._wait.register(self._requests, select.POLLOUT)
        try:
            while message:
                with contextlib.suppress(BlockingIOError):
                    message = message[os.write(self._requests, message) :]
                if message:
                    self._take(self._remaining(began))
        except BrokenPipeError:
            raise self._ended() from None
        finally:
            self._wait.unregister(self._requests)

    def _answer(self, mark: bytes, began: float) -> Message:
        """Its answer, if it is one."""
        while True:
            if len(self._came) >= HEAD.size:
                length, kind, theirs = HEAD.unpack_from(self._came)
                most = {ANSWER: MOST_NUMBERS, FAULT: MOST_WORDS}.get(kind, -1)
                if theirs != mark or length > most:
                    raise self.refused("writes to the exchange itself; only what it returns counts")
                end = HEAD.size + length
                if len(self._came) >= end:
                    content = bytes(self._came[HEAD.size : end])
                    del self._came[:end]
                    return Message(kind, mark, content)
            if not self._take(self._remaining(began)):
                raise self._ended()

    def _remaining(self, began: float) -> float:
        """Seconds that are left to it. Raises FaultError where there are none."""
        left = self._left + GRACE - (time.monotonic() - began)
        if left <= 0:
            raise self.refused(self._limits.too_long)
        return left

    def _take(self, seconds: float) -> bool:
        """Wait for what it writes or prints, and take it in; False where it answers no more."""
        for pipe, _ in self._wait.poll(seconds * 1000):
            if pipe == self._requests:
                continue
            try:
                part = os.read(pipe, CHUNK)
            except BlockingIOError:
                continue
            if not part:
                self._wait.unregister(pipe)
            if pipe == self._answers:
                self._came += part
                if not part:
                    return False
                if len(self._came) > HEAD.size + MOST_NUMBERS:
                    raise self.refused("writes to the exchange itself; only what it returns counts")
            else:
                self._printed += len(part)
                self._kept += part[: max(0, 4 * self._limits.printed - len(self._kept))]
        return True

    def refused(self, wrong: str) -> FaultError:
        """What it did is no answer: it is ended, and not asked again."""
        self.end()
        return FaultError(self._label, wrong)

    def _ended(self) -> FaultError:
        """It has ended, or closed the exchange, where it should have answered."""
        try:
            status = self._process.wait(GRACE)
        except subprocess.TimeoutExpired:
            return self.refused("closed the exchange instead of answering")
        self.end()
        limits = self._limits
        if status == TOO_MANY:
            wrong = f"started more than {limits.processes} processes"
        elif status in (128 + signal.SIGXCPU, 128 + signal.SIGKILL):
            wrong = f"was killed: more than {limits.cpu_seconds} s of CPU"
        elif status > 128:
            wrong = f"crashed: {signal.strsignal(status - 128)}"
        elif status < 0:
            wrong = "killed the process that watches over it"
        else:
            wrong = f"ended its process with status {status} instead of answering"
        return FaultError(self._label, wrong)

    @property
    def printed(self) -> tuple[str, int]:
        """The beginning of what it printed, and how many bytes there were in all."""
        return self._kept.decode(errors="replace"), self._printed

    def end(self) -> None:
        """Kill it, and all that it started."""
        self.ended = True
        process = self._process
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()
        try:
            process.wait(ENDING)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
