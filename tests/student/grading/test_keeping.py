"""A grade is kept by all that it depends on."""

import pytest

from ekfsim.errors import UsageError
from ekfsim.files.homework import read_homework
from ekfsim.student.grading.keeping import digest_of, kept_in, record
from ekfsim.student.grading.scores import Grade, Scored
from ekfsim.student.grading.submissions import Submission


@pytest.fixture
def kept(asked, tmp_path):
    """A homework, a submission that is graded, and what is kept."""
    homework, _, scores = asked("steps: {scenes: [square]}")
    file = tmp_path / "anna.py"
    file.write_text("1")
    one = Submission(file, "anna")
    grade = Grade("anna", (scores[0].earned(1.0),), digest_of(homework, one))
    with kept_in(tmp_path / "work", tmp_path / "results", (scores[0].check,)) as folder:
        folder.add(one, grade)
        yield homework, one, folder


def test_a_grade_is_kept_as_long_as_nothing_changes(kept):
    homework, one, folder = kept
    assert folder.has(one, digest_of(homework, one))
    assert folder.grade(one).cents == 1000
    homework.path.write_text(homework.path.read_text().replace("square", "tour"))
    assert not folder.has(one, digest_of(read_homework(homework.path), one))
    before = digest_of(homework, one)
    one.path.write_text("2")
    assert digest_of(homework, one) != before
    assert not folder.has(one, digest_of(homework, one))


def test_what_was_not_judged_is_tried_again(kept):
    homework, one, folder = kept
    digest = digest_of(homework, one)
    check = folder.checks[0]
    folder.add(one, Grade("anna", (Scored(check).lost("it died"),), digest))
    assert not folder.has(one, digest)


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"tests": []}', "\xff"])
def test_a_damaged_grade_is_none(kept, text):
    homework, one, folder = kept
    folder.path(one).write_text(text)
    assert not folder.has(one, digest_of(homework, one))


def test_two_graders_do_not_share_a_folder(kept, tmp_path):
    _, _, folder = kept
    another = kept_in(folder.work, tmp_path / "results", folder.checks)
    with pytest.raises(UsageError, match="another grader is at work there"), another:
        pass


def test_earlier_results_are_taken_over(kept, tmp_path):
    homework, one, folder = kept
    (tmp_path / "results").mkdir()
    folder.path(one).rename(tmp_path / "results" / record(one))
    assert folder.has(one, digest_of(homework, one))
    assert folder.grade(one).cents == 1000
