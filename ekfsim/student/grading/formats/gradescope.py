"""results.json of Gradescope, with the fields that its specification has (January 2025)."""

from typing import Any

from ekfsim.files.keys.homework import CENTS
from ekfsim.printable import in_a_line
from ekfsim.student.grading.formats.report import summed, words_of
from ekfsim.student.grading.scores import Grade, Scored


def results(grade: Grade) -> dict[str, Any]:
    """What `run_autograder` leaves in results/results.json. Every test is in it, whatever became
    of it; its score is a number from 0 to its most.
    """
    return {
        "score": grade.cents / CENTS,
        "output": f"{summed(grade)}.",
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": list(map(_test, grade.scores)),
        "extra_data": {
            "max_score": grade.most / CENTS,
            "judged": grade.judged / CENTS,
            "mistakes": list(grade.mistakes),
        },
    }


def nothing_yet(why: str) -> dict[str, Any]:
    """What stands there before the first test has ended: 0 points, and why."""
    return {
        "score": 0.0,
        "output": why,
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [],
    }


def _test(score: Scored) -> dict[str, Any]:
    check = score.check
    return {
        "score": score.cents / CENTS,
        "max_score": check.cents / CENTS,
        "status": "passed" if score.status == "passed" else "failed",
        "name": in_a_line(check.name),
        "name_format": "text",
        "number": check.number,
        "output": "\n".join(map(in_a_line, words_of(score))),
        "output_format": "text",
        "tags": [check.kind, in_a_line(check.about)],
        "visibility": check.visibility,
        "extra_data": {
            "judged": score.judged,
            "first_wrong": score.first_wrong,
            "mistakes": [one.mistake for one in score.shown],
        },
    }
