"""A submission in words: points, test by test, and why."""

from collections.abc import Iterator

from ekfsim.files.keys.homework import HomeworkKeys
from ekfsim.student.grading.formats.inert import page
from ekfsim.student.grading.scores import Grade, Scored, points
from ekfsim.version import VERSION


def report(keys: HomeworkKeys, grade: Grade) -> str:
    """A page of Markdown."""
    return "\n".join(_lines(keys, grade)) + "\n"


def summed(grade: Grade) -> str:
    """The points in a sentence; where something was not judged, both sums."""
    told = f"{points(grade.cents)} of {points(grade.most)} points"
    if grade.is_whole:
        return told
    left = grade.most - grade.judged
    return (
        f"{told}; {points(left)} of them were not judged, by no fault of the submission: "
        f"{points(grade.cents)} of the {points(grade.judged)} that were"
    )


def words_of(score: Scored) -> tuple[str, ...]:
    """What is said of a test, a line each."""
    return score.words or ("all of it is right" if score.status == "passed" else score.status,)


def _lines(keys: HomeworkKeys, grade: Grade) -> Iterator[str]:
    yield f"# {page(keys.homework)}: {page(grade.submission)}"
    yield ""
    yield f"**{summed(grade)}.**"
    yield ""
    yield "| test | points | of | |"
    yield "|---|---:|---:|---|"
    for score in grade.scores:
        name = f"{score.check.number} {page(score.check.name)}"
        yield f"| {name} | {points(score.cents)} | {points(score.check.cents)} | {score.status} |"
    for score in grade.scores:
        yield ""
        yield f"## {score.check.number} {page(score.check.name)}"
        yield ""
        for line in words_of(score):
            yield f"- {page(line)}"
    yield ""
    yield f"ekfsim {VERSION}"
