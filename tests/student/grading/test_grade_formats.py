"""Grades as files, held against what their readers ask for."""

import csv
import io
import json
import re
from xml.etree import ElementTree as ET

import pytest

from ekfsim.errors import UsageError
from ekfsim.files.keys.homework import HomeworkKeys
from ekfsim.student.grading.formats.class_page import Class, class_page
from ekfsim.student.grading.formats.folder import formats_in
from ekfsim.student.grading.formats.gradescope import nothing_yet, results
from ekfsim.student.grading.formats.junit import Suites
from ekfsim.student.grading.formats.report import report
from ekfsim.student.grading.formats.table import Table
from ekfsim.student.grading.scores import Grade, Scored, Shown, checks_of

KEYS = HomeworkKeys.model_validate(
    {
        "homework": "EKF & <more>",
        "total": 30,
        "parts": [
            {"name": "=a|b", "points": 20, "steps": {"scenes": ["tour", "square"]}},
            {"name": "c", "points": 10, "honesty": {"scenes": ["tour"]}, "visibility": "hidden"},
        ],
    }
)
CHECKS = checks_of(KEYS)
EVIL = "mine.py:1: \x00\x1b[31m<script>|![x](http://y)\ud800\uffff\n# head"
# Gradescope's specification (January 2025): the fields, and what they may hold
TOP = {
    "score", "execution_time", "output", "output_format", "test_output_format", "test_name_format",
    "visibility", "stdout_visibility", "extra_data", "tests", "leaderboard",
}  # fmt: skip
TEST = {
    "score", "max_score", "status", "name", "name_format", "number", "output", "output_format",
    "tags", "visibility", "extra_data",
}  # fmt: skip
WORDS = {"hidden", "after_due_date", "after_published", "visible"}
FORMATS = {"text", "html", "simple_format", "md", "ansi"}


def grade(name="anna"):
    first, second, third = map(Scored, CHECKS)
    wrong = Scored(
        first.check, words=(EVIL, "b"), fault=EVIL, first_wrong="tour: step 2 (sense 90°)",
        shown=(Shown("innovation-sign", "tour", 3),),
    ).earned(0.123)  # fmt: skip
    return Grade(name, (wrong, second.earned(1.0), third.lost("not judged: it died")))


def whole(name="zoe"):
    return Grade(name, tuple(Scored(check).earned(1.0) for check in CHECKS))


@pytest.mark.parametrize("made", [grade(), whole(), Grade.begun("a", CHECKS)])
def test_gradescope_s_results_are_as_it_specifies_them(made):
    told = json.loads(json.dumps(results(made), allow_nan=False))
    assert set(told) <= TOP
    assert told["visibility"] in WORDS
    assert told["stdout_visibility"] in WORDS
    assert {told[key] for key in told if key.endswith("_format")} <= FORMATS
    assert len(told["tests"]) == len(CHECKS)
    for test, check in zip(told["tests"], CHECKS, strict=True):
        assert set(test) <= TEST
        assert test["status"] in ("passed", "failed")
        assert test["visibility"] == check.visibility
        assert test["output_format"] in FORMATS
        assert type(test["score"]) is type(test["max_score"]) is float
        assert 0 <= test["score"] <= test["max_score"]
        assert all(isinstance(tag, str) for tag in test["tags"])
        assert re.fullmatch(r"\d+\.\d+", test["number"])
    assert told["score"] == pytest.approx(sum(test["score"] for test in told["tests"]))
    assert len({test["name"] for test in told["tests"]}) == len(CHECKS)


def test_gradescope_s_results_say_what_was_not_judged():
    told = results(grade())
    assert told["output"] == (
        "11.23 of 30 points; 10 of them were not judged, by no fault of the submission: 11.23 of "
        "the 20 that were."
    )
    assert told["tests"][2]["output"] == "not judged: it died"
    begun = nothing_yet("it began")
    assert (begun["score"], begun["tests"], set(begun) <= TOP) == (0.0, [], True)


def test_a_table_has_a_row_each_and_no_formula():
    file = io.StringIO()
    table = Table(KEYS, file)
    for made in (grade("=1+1"), whole()):
        table.add(made)
    head, first, second = csv.reader(io.StringIO(file.getvalue()))
    told = dict(zip(head, first, strict=True))
    assert head == [
        *("submission", "points", "of", "judged", "'=a|b", "c"),
        *("first wrong step", "mistakes", "faults"),
    ]
    assert told["submission"] == "'=1+1"
    assert (told["points"], told["of"], told["judged"], told["c"]) == ("11.23", "30", "20", "0")
    assert (told["first wrong step"], told["mistakes"]) == (
        "tour: step 2 (sense 90°)", "innovation-sign",
    )  # fmt: skip
    assert second[:6] == ["zoe", "30", "30", "30", "20", "10"]


def test_a_build_server_s_file_is_xml_whatever_was_handed_in():
    file = io.StringIO()
    suites = Suites(KEYS, file)
    for made in (grade("a\x08<b>\ud800"), whole()):
        suites.add(made)
    suites.close()
    root = ET.fromstring(file.getvalue().encode())
    assert (root.tag, root.get("name")) == ("testsuites", "EKF & <more>")
    first, second = root
    counts = ("tests", "failures", "errors", "skipped")
    assert [first.get(name) for name in counts] == ["3", "1", "1", "0"]
    assert [second.get(name) for name in counts] == ["3", "0", "0", "0"]
    assert [[child.tag for child in case] for case in first] == [["failure"], [], ["error"]]
    assert first[0][0].get("message") == "1.23 of 10 points"
    assert "<script>" in first[0][0].text
    assert [len(case) for case in second] == [0, 0, 0]


def test_a_report_tells_points_and_reasons_and_is_inert():
    told = report(KEYS, grade())
    assert told.startswith(
        "# EKF \\& \\<more\\>: anna\n\n**11.23 of 30 points; 10 of them were not"
    )
    assert "| 1.1 =a\\|b: tour | 1.23 | 10 | failed |" in told
    assert "| 2.1 c: tour | 0 | 10 | not run |" in told
    assert "\n- all of it is right\n" in told
    assert "<script>" not in told.replace("\\<script\\>", "")
    assert not re.search(r"[\x00-\x09\x0b-\x1f\ud800-\udfff]", told)
    assert "![x]" not in told


def test_a_page_of_the_class_counts_and_names_nobody():
    of = Class()
    for made in (grade("anna"), grade("bob"), whole("zoe")):
        of.add(made)
    told = class_page(KEYS, CHECKS, of)
    assert "3 submissions; of 30 points the mean is 17.49, the median 11.23." in told
    assert "| 1.1 =a\\|b: tour | 4.15 | 10 | 1 | 2 |" in told
    assert re.search(r"\| innovation-sign \| 2 \| tour \(2\) \| eqs? ", told)
    assert not re.search("anna|bob|zoe|mine.py", told)
    assert of.unjudged == 2
    of.add(whole("yan"))
    assert "the mean is 20.62, the median 20.62." in class_page(KEYS, CHECKS, of)  # of 11.23 and 30


def test_formats_are_named_in_any_order():
    assert formats_in("markdown, csv") == ("csv", "markdown")
    with pytest.raises(UsageError) as refused:
        formats_in("csv,gradscope")
    assert str(refused.value) == ("--format: 'gradscope' is no format; did you mean 'gradescope'?")
