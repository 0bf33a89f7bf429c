"""Over there: who starts the process with the student's code, and ends whatever that started.

It holds no number of a student's and calls nothing of it. On Linux all that loses its parent below
it becomes its child (PR_SET_CHILD_SUBREAPER), whatever session it has gone to: when it has no child
left, nothing is left. It ends when the code's process does, when it is told to (SIGTERM), or when
the other end of the exchange is closed, be it because the parent was killed: then it deletes the
folder, too.
"""

import os
import select
import signal
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from ekfsim.student.sandbox.kernel import SET_CHILD_SUBREAPER, SET_PDEATHSIG, prctl
from ekfsim.student.sandbox.limits import Limits

TICK = 0.2  # s between two looks at how many processes there are
KILLING = 5.0  # s; by then whoever can be killed is dead
TOO_MANY = 255  # the status that tells of too many processes
MOST_LEFT = 100  # so many are told of by a status


def main(asked: Mapping[str, Any]) -> None:
    """Start the process that answers; see it to its end, and its children's.

    Ends with its status, 128 + n where signal n ended it, TOO_MANY, or, where the parent ends it,
    how many other processes it has left running.
    """
    requests, answers, limits = os.dup(0), os.dup(1), Limits(**asked["limits"])
    prctl(SET_CHILD_SUBREAPER, 1)
    keeper = os.getpid()
    student = os.fork()
    if student == 0:
        try:
            os.setsid()
            prctl(SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() == keeper:
                from ekfsim.student.sandbox.answering import serve

                serve(requests, answers, asked, limits)
        except BaseException as error:
            os.write(2, f"{type(error).__name__}: {error}\n".encode(errors="replace"))
        finally:
            os._exit(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2, answers):  # or nobody would see the other end close
        os.dup2(nowhere, descriptor)
    signal.signal(signal.SIGTERM, _enough)
    try:
        status = _seen_to_its_end(student, requests, limits)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # nothing ends what is to end the others
    except InterruptedError:
        status = _left(student)
    _end_all(student)
    if _closed(requests):  # perhaps the parent was killed, and deletes nothing more
        from ekfsim.student.sandbox.folder import remove

        remove(Path(asked["folder"]))
    os._exit(status)


def _enough(number: int, frame: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise InterruptedError


def _seen_to_its_end(student: int, requests: int, limits: Limits) -> int:
    """Wait until the process ends, or should: the status to end with."""
    waited = _closing(requests)
    if hasattr(os, "pidfd_open"):
        with suppress(OSError):
            waited.register(os.pidfd_open(student), select.POLLIN)
    counted = os.getuid() == 0 and sys.platform == "linux"  # for others, the kernel counts
    while True:
        waited.poll(TICK * 1000)
        closed = _closed(requests)
        done, status, took = os.wait4(student, os.WNOHANG)
        if done:
            code = os.waitstatus_to_exitcode(status)
            if code == 0 and _closed(requests):  # it has only been quicker to see that
                return _left(student)
            if code == -signal.SIGKILL and took.ru_utime + took.ru_stime > limits.cpu_seconds:
                code = -signal.SIGXCPU  # who heeded no alarm: only the kernel's end is left
            return code if code >= 0 else 128 - code
        if closed:
            return _left(student)
        if counted and sum(1 for _ in descendants(os.getpid())) > limits.processes:
            return TOO_MANY


def _closing(requests: int) -> select.poll:
    """What waits for nothing but the closing of the exchange's other end."""
    waited = select.poll()
    waited.register(requests, 0)
    return waited


def _closed(requests: int) -> bool:
    """Whether it is closed: a killed parent's is, a moment before its children lose it."""
    return bool(_closing(requests).poll(0))


def _left(student: int) -> int:
    """How many processes there are below this one, but for the student's own."""
    return min(sum(1 for process in descendants(os.getpid()) if process != student), MOST_LEFT)


def _end_all(student: int) -> None:
    """Kill all that is left, until nothing is."""
    until = time.monotonic() + KILLING
    while time.monotonic() < until:
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(student, signal.SIGKILL)
        for process in list(descendants(os.getpid())):
            with suppress(ProcessLookupError, PermissionError):
                os.kill(process, signal.SIGKILL)
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        time.sleep(0.002)


def descendants(ancestor: int) -> Iterator[int]:
    """The processes below one, by /proc; none where there is no /proc."""
    children: dict[int, list[int]] = {}
    for name in os.listdir("/proc") if sys.platform == "linux" else ():
        if name.isdigit():
            try:
                with open(f"/proc/{name}/stat", "rb") as file:
                    told = file.read()
            except OSError:  # it has ended meanwhile
                continue
            parent = int(told.rpartition(b")")[2].split()[1])  # pid (any name) state parent …
            children.setdefault(parent, []).append(int(name))
    waiting = [ancestor]
    while waiting:
        below = children.get(waiting.pop(), [])
        yield from below
        waiting.extend(below)
