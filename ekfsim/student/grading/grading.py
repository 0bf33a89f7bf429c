"""Submissions → grades, each kept as soon as it is whole."""

from collections.abc import Callable, Sequence
from pathlib import Path

from ekfsim.files.homework import Homework
from ekfsim.student.grading.crew import grades
from ekfsim.student.grading.keeping import Kept, digest_of
from ekfsim.student.grading.scores import Grade
from ekfsim.student.grading.submissions import Submission

Done = Callable[[Grade | None], None]


def work_of(out: Path) -> Path:
    """Where grades are kept until all results can be written."""
    return out.with_name(f"{out.name}.partial")


def grade(
    homework: Homework, submissions: Sequence[Submission], kept: Kept, workers: int,
    through: tuple[str, ...], done: Done,
) -> None:  # fmt: skip
    """Grade what is not graded yet. done : told of each, None where it was already"""
    digests = {one.name: (one, digest_of(homework, one)) for one in submissions}
    missing = [pair for pair in digests.values() if not kept.has(*pair)]
    for _ in range(len(submissions) - len(missing)):
        done(None)
    for made in grades(homework, missing, min(workers, max(len(missing), 1)), through):
        kept.add(digests[made.submission][0], made)
        done(made)
