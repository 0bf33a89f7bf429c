"""What build servers read: a test suite for each submission."""

from typing import TextIO
from xml.etree import ElementTree as ET

from ekfsim.files.keys.homework import HomeworkKeys
from ekfsim.student.grading.formats.inert import xml
from ekfsim.student.grading.formats.report import words_of
from ekfsim.student.grading.scores import Grade, points


class Suites:
    """One suite after another, none of them kept."""

    def __init__(self, keys: HomeworkKeys, file: TextIO) -> None:
        self._file = file
        head = ET.tostring(ET.Element("testsuites", name=xml(keys.homework)), encoding="unicode")
        file.write('<?xml version="1.0" encoding="utf-8"?>\n')
        file.write(f"{head.removesuffix(' />')}>\n")

    def add(self, grade: Grade) -> None:
        """The suite of a submission."""
        self._file.write(ET.tostring(suite(grade), encoding="unicode") + "\n")

    def close(self) -> None:
        """The end of the last."""
        self._file.write("</testsuites>\n")


def suite(grade: Grade) -> ET.Element:
    """A submission: a failure is the student's, an error the grader's."""
    failed = sum(score.status == "failed" for score in grade.scores)
    errors = sum(not score.judged for score in grade.scores)
    element = ET.Element(
        "testsuite", name=xml(grade.submission), tests=str(len(grade.scores)),
        failures=str(failed), errors=str(errors), skipped="0", time="0",
    )  # fmt: skip
    for score in grade.scores:
        check = score.check
        case = ET.SubElement(
            element, "testcase", classname=xml(f"{grade.submission}.{check.part}"),
            name=xml(f"{check.number} {check.about}"), time="0",
        )  # fmt: skip
        if score.status == "passed":
            continue
        told = f"{points(score.cents)} of {points(check.cents)} points"
        kind = "failure" if score.judged else "error"
        ET.SubElement(case, kind, type=check.kind, message=told).text = "\n".join(
            map(xml, words_of(score))
        )
    return element
