"""Over there: the process that calls the student's code, and says what came of it.

Whatever the code raises, exits with or breaks is told, if it can be; what cannot be told is seen by
the parent, which believes nothing that comes from here.
"""

import json
import os
import signal
import sys
from collections.abc import Callable, Mapping
from types import FrameType
from typing import Any

from ekfsim.student.fault import FaultError
from ekfsim.student.sandbox.exchange import HEAD, answered, faulted
from ekfsim.student.sandbox.kernel import fence, give_up_privileges
from ekfsim.student.sandbox.limits import ALONE, Limits, TimeOverError, charge, keep_to


def serve(requests: int, answers: int, asked: Mapping[str, Any], limits: Limits) -> None:
    """Answer one request after another, until the other end closes."""
    _prepare(asked, limits)
    from ekfsim.student.own.home import words_of  # NumPy comes after the limits
    from ekfsim.student.sandbox.calling import Requests

    fenced = fence(asked["folder"], [*asked["read"], sys.prefix, sys.base_prefix])
    requested = Requests(asked["place"], asked["provided"], fenced)
    label, alarms = os.path.basename(asked["place"]), Alarms(limits)
    charge(limits)
    read, write, loads, alarm = os.read, os.write, json.loads, signal.setitimer
    while True:
        length, _, mark = HEAD.unpack(_read(read, requests, HEAD.size))
        seconds, questions = loads(_read(read, requests, length))
        alarm(signal.ITIMER_REAL, seconds)
        for what, told in questions:
            failed = True
            try:
                with alarms:
                    message = answered(getattr(requested, what)(*told), mark)
                failed = False
            except FaultError as error:
                message = faulted(error.place, alarms.rung or error.wrong, mark)
            except BaseException as error:  # of the code, where ours calls it: __array__ may exit
                place = _place(error, asked["folder"]) or label
                message = faulted(place, alarms.rung or words_of(error), mark)
            _flush()
            _write(write, answers, message)
            if failed:
                break
        alarm(signal.ITIMER_REAL, 0)


def _prepare(asked: Mapping[str, Any], limits: Limits) -> None:
    """Nothing of whoever started this but the folder, no privileges, no more than the limits."""
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)  # what is printed does not go where answers go
    os.environ.clear()
    os.environ.update(dict.fromkeys(ALONE, "1"))
    os.chdir(asked["folder"])
    os.environ["HOME"] = os.environ["TMPDIR"] = asked["folder"]
    sys.argv[:] = [asked["place"]]
    keep_to(limits)
    give_up_privileges()


class Alarms:
    """Interrupt the code where it is, within a `with`, when its time is over."""

    def __init__(self, limits: Limits) -> None:
        self.rung = ""  # what is told then, of the first
        self._within = False
        self._told = {
            signal.SIGALRM: limits.too_long, signal.SIGPROF: limits.too_busy,
            signal.SIGXCPU: limits.too_busy,
        }  # fmt: skip
        for number in self._told:
            signal.signal(number, self._ring)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        self.rung = self.rung or self._told[signal.Signals(number)]
        if self._within:
            raise TimeOverError(self.rung)

    def __enter__(self) -> None:
        if self.rung:  # a thread of the code went on between two questions
            raise TimeOverError(self.rung)
        self._within = True

    def __exit__(self, *_: object) -> None:
        self._within = False


def _place(error: BaseException, folder: str) -> str:
    """The deepest line in the folder that an exception went through, "" where there is none."""
    from ekfsim.student.own.home import frames

    own = [
        f"{os.path.relpath(file, folder)}:{line}"
        for file, line in frames(error.__traceback__)
        if file.startswith(os.path.join(folder, ""))
    ]
    return own[-1] if own else ""


def _flush() -> None:
    """Let out what the code has printed, if it has left something to print with."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except BaseException:
            continue


def _read(read: Callable[[int, int], bytes], descriptor: int, length: int) -> bytes:
    parts = []
    while length:
        part = read(descriptor, length)
        if not part:
            os._exit(0)
        parts.append(part)
        length -= len(part)
    return b"".join(parts)


def _write(write: Callable[[int, bytes], int], descriptor: int, message: bytes) -> None:
    while message:
        message = message[write(descriptor, message) :]
