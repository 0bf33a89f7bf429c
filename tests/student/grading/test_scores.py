"""Points: nothing is earned that was not handed over, and all of them add up."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ekfsim.files.keys.homework import HomeworkKeys
from ekfsim.student.grading.scores import (
    Check,
    Grade,
    Scored,
    ScoreError,
    Shown,
    checks_of,
    shared_out,
)

CHECK = Check("1.1", "Steps", "steps", "tour", 1000)
KEYS = HomeworkKeys.model_validate(
    {
        "homework": "EKF",
        "total": 100,
        "parts": [
            {"name": "a", "points": 40, "steps": {"scenes": ["tour", "square", "theta"]}},
            {"name": "b", "points": 25, "jacobians": {"functions": ["F", "H"], "scenes": ["tour"]}},
            {"name": "c", "points": 20, "honesty": {"scenes": ["tour"]}, "visibility": "hidden"},
            {"name": "d", "points": 15, "inputs": {"files": 2, "exposed": 5}},
        ],
    }
)


def test_every_test_stands_on_the_list_and_their_points_are_the_total():
    checks = checks_of(KEYS)
    assert [(check.number, check.name, check.cents) for check in checks] == [
        *(("1.1", "a: tour", 1334), ("1.2", "a: square", 1333), ("1.3", "a: theta", 1333)),
        *(("2.1", "b: F", 1250), ("2.2", "b: H", 1250)),
        ("3.1", "c: tour", 2000),
        *(("4.1", "d: promises", 750), ("4.2", "d: exposed mistakes", 750)),
    ]
    assert sum(check.cents for check in checks) == 10000
    assert [check.visibility for check in checks][4:6] == ["visible", "hidden"]


@given(st.integers(0, 10**6), st.integers(1, 50))
def test_shares_add_up_and_are_even(cents, among):
    shares = shared_out(cents, among)
    assert sum(shares) == cents
    assert max(shares) - min(shares) <= 1


def test_a_score_begins_at_nothing_and_not_run():
    score = Scored(CHECK)
    assert (score.cents, score.status, score.judged) == (0, "not run", False)
    grade = Grade.begun("anna", checks_of(KEYS))
    assert (grade.cents, grade.most, grade.judged, grade.is_whole) == (0, 10000, 0, False)


@pytest.mark.parametrize(
    ("share", "cents", "status"),
    [
        (1, 1000, "passed"), (1.0, 1000, "passed"), (0, 0, "failed"), (0.0, 0, "failed"),
        (0.5, 500, "failed"), (2 / 3, 666, "failed"), (1 - 1e-6, 999, "failed"),
        (0.29, 290, "failed"), (np.float64(0.25), 250, "failed"),
    ],
)  # fmt: skip
def test_full_points_are_for_what_is_right_throughout(share, cents, status):
    score = Scored(CHECK).earned(share)
    assert (score.cents, score.status, score.judged) == (cents, status, True)


@pytest.mark.parametrize(
    "share",
    [
        True, False, None, "1", "10", math.nan, math.inf, -math.inf, -0.001, 1.001, 10, [1.0],
        np.array(1.0), np.array([0.5]), np.bool_(True), 1 + 0j,
    ],
    ids=repr,
)  # fmt: skip
def test_what_is_no_share_is_a_failure_of_the_grader(share):
    with pytest.raises(ScoreError):
        Scored(CHECK).earned(share)


def test_where_the_grader_failed_both_sums_are_known():
    first, *others = Grade.begun("anna", checks_of(KEYS)).scores
    grade = Grade("anna", (first.earned(1.0), *(one.lost("it died") for one in others)))
    assert (grade.cents, grade.judged, grade.most, grade.is_whole) == (1334, 1334, 10000, False)


def test_a_grade_comes_back_from_json():
    checks = checks_of(KEYS)
    scores = list(map(Scored, checks))
    scores[0] = Scored(
        checks[0], words=("a", "b"), fault="mine.py:1: x", first_wrong="tour: step 2",
        shown=(Shown("innovation-sign", "tour", 3),),
    ).earned(0.5)  # fmt: skip
    grade = Grade("anna", tuple(scores), "0123")
    plain = json.loads(json.dumps(grade.plain(), allow_nan=False))
    again = Grade.of_plain(checks, plain)
    assert (again, again.digest) == (grade, "0123")
    assert (plain["score"], plain["max_score"], plain["judged"]) == (6.67, 100.0, 13.34)
    assert plain["mistakes"] == ["innovation-sign"]
