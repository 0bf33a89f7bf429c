"""Each grade at once on disk: a grader that is ended goes on with what is missing.

A grade is kept by all that it depends on: the homework with its scenes, the submission, and this
program to the letter. What is of another is not looked at, and graded anew.
"""

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.homework import Homework
from ekfsim.files.results.writing import told, whole_text
from ekfsim.student.grading.scores import Check, Grade
from ekfsim.student.grading.submissions import Submission
from ekfsim.study.running.journal import hold, program

LOCK = "lock"


@dataclass(frozen=True)
class Kept:
    """A folder of work, and one of results that may be there from before."""

    work: Path
    results: Path
    checks: tuple[Check, ...]

    def path(self, submission: Submission) -> Path:
        """Where the grade of a submission is kept."""
        return self.work / record(submission)

    def has(self, submission: Submission, digest: str) -> bool:
        """Whether it is graded already, wholly; a grade from earlier results is taken over."""
        for folder in (self.work, self.results):
            grade = self._read(folder / record(submission))
            if grade is not None and grade.digest == digest and grade.is_whole:
                if folder is self.results:
                    self.add(submission, grade)
                return True
        return False

    def add(self, submission: Submission, grade: Grade) -> None:
        """Keep a grade. When this returns, this process may end."""
        with whole_text(self.path(submission), force=True) as file:
            file.write(as_json(grade.plain()))

    def grade(self, submission: Submission) -> Grade:
        """The grade of a submission that has one."""
        grade = self._read(self.path(submission))
        if grade is None:
            raise UsageError(f"{self.path(submission)}: vanished while it was needed; begin again")
        return grade

    def _read(self, path: Path) -> Grade | None:
        try:
            return Grade.of_plain(self.checks, json.loads(path.read_bytes()))
        except (OSError, ValueError, KeyError, TypeError):
            return None


def digest_of(homework: Homework, submission: Submission) -> str:
    """All that a grade depends on, as a word."""
    told = "\n".join((homework.digest, submission.digest, program()))
    return hashlib.sha256(told.encode()).hexdigest()


def record(submission: Submission) -> str:
    """The name of the file with all that is known of a submission's grade."""
    return f"report-{submission.safe}.json"


def as_json(plain: object) -> str:
    """Numbers that JSON has; nan is none."""
    return json.dumps(plain, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


@contextmanager
def kept_in(work: Path, results: Path, checks: tuple[Check, ...]) -> Iterator[Kept]:
    """The folder of work, for this process alone. Raises UsageError where another is at it."""
    with told(work):
        work.mkdir(parents=True, exist_ok=True)
        file = open(work / LOCK, "wb")  # noqa: SIM115
    with file:
        hold(file, work, "grader")
        yield Kept(work, results, checks)


def remove(work: Path) -> None:
    """Delete the folder of work, with the grades that are kept in it."""
    with suppress(OSError):
        for path in [*work.glob("report-*.json"), work / LOCK]:
            with suppress(OSError):
                os.unlink(path)
        work.rmdir()
