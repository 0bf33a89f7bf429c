"""Processes that grade: one that dies costs the test that it was at, and no more."""

import pytest

from ekfsim.student.grading import crew
from ekfsim.student.grading.scores import Scored
from ekfsim.student.grading.submissions import Submission

DIES, HANGS = "dies", "hangs"


class Process:
    """In the place of a process that grades: what it would tell, at once."""

    def __init__(self):
        self.told, self.is_over = [], False

    def terminate(self):
        self.is_over = True

    def join(self, timeout=None):
        self.is_over = True

    def is_alive(self):
        return False


class Pipe:
    """Passes everything but what a submission's name says; it dies or hangs at its second test."""

    def __init__(self, checks):
        self.checks, self.waiting = checks, []

    def send(self, asked):
        _, name, left = asked
        for number in left:
            if number == 1 and name in (DIES, HANGS):
                self.waiting.append(name)
                return
            self.waiting.append((number, Scored(self.checks[number]).earned(1.0).plain()))

    def recv(self):
        told = self.waiting.pop(0)
        if told == DIES:
            raise EOFError
        return told

    def close(self):
        pass


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_one_that_dies_or_hangs_costs_one_test(asked, tmp_path, monkeypatch, workers):
    homework, _, scores = asked("steps: {scenes: [square, theta, tour]}")
    checks = tuple(score.check for score in scores)
    begun = []

    def begin(homework, through):
        begun.append(crew.Hand(Process(), Pipe(checks)))
        return begun[-1]

    clock = iter(range(10**6))
    monkeypatch.setattr(crew, "_begun", begin)
    monkeypatch.setattr(crew.time, "monotonic", lambda: 10.0 * next(clock))
    monkeypatch.setattr(
        crew, "wait",
        lambda pipes, timeout: [one for one in pipes if one.waiting and one.waiting[0] != HANGS],
    )  # fmt: skip
    names = ["anna", DIES, "bob", HANGS, "zoe"]
    jobs = [(Submission(tmp_path, name), name) for name in names]
    made = {one.submission: one for one in crew.grades(homework, jobs, workers)}
    assert set(made) == set(names)
    for name, grade in made.items():
        assert grade.digest == name
        expected = [True, name not in (DIES, HANGS), True]
        assert [score.judged for score in grade.scores] == expected
        assert [score.status == "passed" for score in grade.scores] == expected
    assert made[DIES].scores[1].words == ("not judged: the process that graded it died",)
    assert made[HANGS].scores[1].words[0].startswith("not judged: it took the grader longer than")
    assert all(hand.process.is_over for hand in begun)
