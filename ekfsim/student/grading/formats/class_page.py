"""The page of a class: which mistakes it made, how many, which scenes show them. No names."""

import statistics
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from ekfsim.files.keys.homework import HomeworkKeys
from ekfsim.student.grading.formats.inert import page
from ekfsim.student.grading.scores import Check, Grade, points
from ekfsim.student.mistakes.known import BY_NAME
from ekfsim.version import VERSION


@dataclass
class Class:
    """Counts over submissions; its size knows no number of them."""

    grades: Counter[int] = field(default_factory=Counter)  # by hundredths
    cents: Counter[str] = field(default_factory=Counter)  # by test
    passed: Counter[str] = field(default_factory=Counter)
    faulty: Counter[str] = field(default_factory=Counter)  # whose code failed in it
    mistakes: Counter[str] = field(default_factory=Counter)
    scenes: dict[str, Counter[str]] = field(default_factory=dict)  # by mistake
    unjudged: int = 0  # submissions of which something was not judged

    def add(self, grade: Grade) -> None:
        """One submission more."""
        self.grades[grade.cents] += 1
        self.unjudged += not grade.is_whole
        for score in grade.scores:
            number = score.check.number
            self.cents[number] += score.cents
            self.passed[number] += score.status == "passed"
            self.faulty[number] += bool(score.fault)
        self.mistakes.update(grade.mistakes)
        pairs = {(one.mistake, one.scene) for score in grade.scores for one in score.shown}
        for mistake, scene in sorted(pairs):
            self.scenes.setdefault(mistake, Counter())[scene] += 1

    def summed(self, keys: HomeworkKeys) -> str:
        """How many there are, and their points."""
        many = self.grades.total()
        if not many:
            return "no submission"
        total = sum(cents * n for cents, n in self.grades.items())
        middle = round(statistics.median(self.grades.elements()))
        return (
            f"{many} submission{'s' * (many != 1)}; of {keys.total:g} points the mean is "
            f"{points(round(total / many))}, the median {points(middle)}"
        )


def class_page(keys: HomeworkKeys, checks: Iterable[Check], of: Class) -> str:
    """A page of Markdown."""
    return "\n".join(_lines(keys, checks, of)) + "\n"


def _lines(keys: HomeworkKeys, checks: Iterable[Check], of: Class) -> Iterator[str]:
    many = of.grades.total()
    yield f"# {page(keys.homework)}: the class"
    yield ""
    yield f"{of.summed(keys)}."
    yield ""
    yield "| test | mean | of | all right | code failed |"
    yield "|---|---:|---:|---:|---:|"
    for check in checks:
        number = check.number
        mean = points(round(of.cents[number] / many)) if many else "–"
        yield (
            f"| {number} {page(check.name)} | {mean} | {points(check.cents)} | "
            f"{of.passed[number]} | {of.faulty[number]} |"
        )
    yield ""
    yield "## Mistakes"
    yield ""
    if not of.mistakes:
        yield "None of the known ones was found."
    else:
        yield "| mistake | submissions | shown by | to read again |"
        yield "|---|---:|---|---|"
    for name, n in sorted(of.mistakes.items(), key=lambda pair: (-pair[1], pair[0])):
        shown = ", ".join(f"{page(scene)} ({k})" for scene, k in sorted(of.scenes[name].items()))
        read = BY_NAME[name].read if name in BY_NAME else ""
        yield f"| {page(name)} | {n} | {shown} | {page(read)} |"
    yield ""
    yield f"ekfsim {VERSION}"
