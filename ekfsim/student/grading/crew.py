"""Processes that grade side by side; the one that asks them holds points and words alone.

Each takes a submission, tells of every test as it ends, and takes the next. One that dies, or takes
far longer than a student's code may, costs the test that it was at; another takes the rest of the
submission.
"""

import multiprocessing
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path

from ekfsim.files.homework import Homework, read_homework
from ekfsim.student.grading.examining import Examiner
from ekfsim.student.grading.scores import Check, Grade, Scored, checks_of
from ekfsim.student.grading.submissions import Submission
from ekfsim.student.sandbox.limits import patience as waited
from ekfsim.study.running.engines import one_thread_each

SLOWER = 3  # by so much we may take longer than a student's code is waited for
START = 120.0  # s, until a process has begun
MOST_MEMORY = 4096  # MiB of a process that grades
ENDING = 5.0  # s
STEPS_AT_ONCE = 1.0  # s between two looks at the clock


@dataclass
class Job:
    """A submission, and the tests of it that are still to be done."""

    submission: Submission
    digest: str
    scores: list[Scored]
    left: deque[int]  # places in the scores


@dataclass
class Hand:
    """A process that grades, and what it is at."""

    process: BaseProcess
    ours: Connection
    job: Job | None = None
    until: float = field(default=0.0)  # when it is to have told of its test


def grades(
    homework: Homework, jobs: Iterable[tuple[Submission, str]], workers: int,
    through: tuple[str, ...] = (),
) -> Iterator[Grade]:  # fmt: skip
    """A grade for each submission, in the order in which they are done."""
    checks = checks_of(homework.keys)
    waiting = _jobs(jobs, checks)
    again: list[Job] = []
    hands: list[Hand] = []
    patience = START + SLOWER * waited(homework.keys.limits.seconds)
    try:
        while True:
            for hand in list(hands):
                if hand.job is None and not _next(hand, again, waiting, patience):
                    hands.remove(hand)
                    _end(hand)
            while len(hands) < workers:
                hand = _begun(homework, through)
                if not _next(hand, again, waiting, patience):
                    _end(hand)
                    break
                hands.append(hand)
            if not hands:
                return
            yield from _told(hands, again, patience)
    finally:
        for hand in hands:
            _end(hand, now=True)


def _jobs(jobs: Iterable[tuple[Submission, str]], checks: tuple[Check, ...]) -> Iterator[Job]:
    for submission, digest in jobs:
        yield Job(submission, digest, list(map(Scored, checks)), deque(range(len(checks))))


def _next(hand: Hand, again: list[Job], waiting: Iterator[Job], patience: float) -> bool:
    """Hand it a submission, one that another left first; False where there is none."""
    job = again.pop() if again else next(waiting, None)
    if job is None:
        return False
    hand.job, hand.until = job, time.monotonic() + patience
    with suppress(OSError):  # that it is dead is seen where its words are waited for
        hand.ours.send((job.submission.path, job.submission.name, list(job.left)))
    return True


def _told(hands: list[Hand], again: list[Job], patience: float) -> Iterator[Grade]:
    """Wait for what they tell; the grades that become whole by it."""
    ready = set(wait([hand.ours for hand in hands], timeout=STEPS_AT_ONCE))
    for hand in list(hands):
        assert hand.job is not None
        if hand.ours in ready:
            try:
                number, plain = hand.ours.recv()
            except (EOFError, OSError):
                why = "not judged: the process that graded it died"
                yield from _lost(hand, hands, again, why)
                continue
            if number is not None:
                score = hand.job.scores[number]
                hand.job.scores[number] = Scored.of_plain(score.check, plain)
                hand.job.left.remove(number)
                hand.until = time.monotonic() + patience
            if not hand.job.left:
                yield _grade(hand.job)
                hand.job = None
        elif time.monotonic() > hand.until:
            why = f"not judged: it took the grader longer than {patience:g} s"
            yield from _lost(hand, hands, again, why)


def _lost(hand: Hand, hands: list[Hand], again: list[Job], why: str) -> Iterator[Grade]:
    """A process is at its end, and the test that it was at."""
    job = hand.job
    assert job is not None
    number = job.left.popleft()
    job.scores[number] = job.scores[number].lost(why)
    hands.remove(hand)
    _end(hand, now=True)
    if job.left:
        again.append(job)
    else:
        yield _grade(job)


def _grade(job: Job) -> Grade:
    return Grade(job.submission.name, tuple(job.scores), job.digest)


def _begun(homework: Homework, through: tuple[str, ...]) -> Hand:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    told = str(homework.path), homework.digest, through
    process = context.Process(target=work, args=(theirs, *told), daemon=False)
    # until it leaves Ctrl-C to us it hears none
    heard = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        with one_thread_each():
            process.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, heard)
    theirs.close()
    return Hand(process, ours)


def _end(hand: Hand, now: bool = False) -> None:
    hand.ours.close()
    if now:
        hand.process.terminate()
    hand.process.join(ENDING)
    if hand.process.is_alive():
        hand.process.kill()
        hand.process.join()


def work(theirs: Connection, path: str, digest: str, through: tuple[str, ...]) -> None:
    """Over there: grade one submission after another, until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # it ends with whoever asks it
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))  # and cleans up
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _keep_memory()
    homework = read_homework(Path(path))
    if homework.digest != digest:
        sys.exit(1)
    examiner = Examiner(homework, through)
    with suppress(EOFError, OSError):
        while True:
            place, name, left = theirs.recv()
            submission = Submission(Path(place), name)
            for number in left:
                score = examiner.examine(examiner.checks[number], submission)
                theirs.send((number, score.plain()))


def _end_with_parent() -> None:
    """A student's code that never ends must not outlive whoever wanted to know of it."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os.kill(os.getpid(), signal.SIGTERM)


def _keep_memory() -> None:
    """Whoever grades takes no more than so much, whatever is in a student's files."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        most = MOST_MEMORY * 2**20
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        if hard == resource.RLIM_INFINITY or hard > most:
            resource.setrlimit(resource.RLIMIT_AS, (most, hard))
