"""All results in a folder, whole or absent; one submission after another, none of them kept."""

import difflib
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Literal, TextIO

from ekfsim.errors import UsageError
from ekfsim.files.homework import Homework
from ekfsim.files.results.writing import whole_folder
from ekfsim.printable import quoted
from ekfsim.student.grading.formats import gradescope
from ekfsim.student.grading.formats.class_page import Class, class_page
from ekfsim.student.grading.formats.junit import Suites
from ekfsim.student.grading.formats.report import report
from ekfsim.student.grading.formats.table import Table
from ekfsim.student.grading.keeping import as_json, record
from ekfsim.student.grading.scores import Grade, checks_of
from ekfsim.student.grading.submissions import Submission

Format = Literal["csv", "gradescope", "junit", "markdown"]
FORMATS: tuple[Format, ...] = ("csv", "gradescope", "junit", "markdown")
FILES = ("grades.csv", "class.md", "junit.xml", "report-*.md", "report-*.json", "gradescope-*.json")


def formats_in(text: str) -> tuple[Format, ...]:
    """The formats that a list names: csv,junit. Raises UsageError for what is none."""
    named = [name.strip() for name in text.split(",")]
    for name in named:
        if name not in FORMATS:
            near = difflib.get_close_matches(name, FORMATS, 1)
            right = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(FORMATS)}"
            raise UsageError(f"--format: {quoted(name)} is no format; {right}")
    return tuple(one for one in FORMATS if one in named)


def write_grades(
    homework: Homework,
    submissions: Iterable[Submission],
    grade_of: Callable[[Submission], Grade],
    out: Path,
    formats: Sequence[Format],
    force: bool,
) -> Class:
    """Write every file that is asked for; what is counted over all."""
    keys, of_all = homework.keys, Class()
    with whole_folder(out, *FILES, force=force) as folder, ExitStack() as stack:

        def opened(name: str) -> TextIO:
            return stack.enter_context(_text(folder / name))

        table = Table(keys, opened("grades.csv")) if "csv" in formats else None
        suites = Suites(keys, opened("junit.xml")) if "junit" in formats else None
        for submission in submissions:
            grade = grade_of(submission)
            of_all.add(grade)
            _write(folder / record(submission), as_json(grade.plain()))
            if table is not None:
                table.add(grade)
            if suites is not None:
                suites.add(grade)
            if "markdown" in formats:
                _write(folder / f"report-{submission.safe}.md", report(keys, grade))
            if "gradescope" in formats:
                told = as_json(gradescope.results(grade))
                _write(folder / f"gradescope-{submission.safe}.json", told)
        if suites is not None:
            suites.close()
        if "markdown" in formats:
            _write(folder / "class.md", class_page(keys, checks_of(keys), of_all))
    return of_all


def _text(path: Path) -> TextIO:
    return open(path, "w", encoding="utf-8", errors="replace", newline="\n")


def _write(path: Path, text: str) -> None:
    with _text(path) as file:
        file.write(text)
