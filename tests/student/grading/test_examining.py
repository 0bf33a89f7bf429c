import os
import sys
import time

import pytest
from student.sandbox.broken import doing

from ekfsim.student.grading.examining import Examiner, at_most
from ekfsim.student.grading.submissions import Submission
from ekfsim.student.sandbox.limits import TimeOverError

STAYS = """\
if u[0] and not os.path.exists("begun"):
    open("begun", "w").close()
    print("away")
    hear, tell = os.pipe()
    if os.fork() == 0:
        os.setsid()
        os.close(1)
        os.close(2)
        os.write(tell, b"gone")
        time.sleep(60)
    os.read(hear, 4)  # else it may be ended before it has left its group"""


@pytest.mark.skipif(sys.platform != "linux", reason="nobody takes in orphans elsewhere")
def test_what_a_right_filter_prints_and_leaves_running_is_told_and_costs_nothing(asked, tmp_path):
    homework, _, [score] = asked("steps: {scenes: [square]}")
    file = tmp_path / "mine.py"
    file.write_text(doing(STAYS))
    made = Examiner(homework).examine(score.check, Submission(file, "anna"))
    assert made.words[-2:] == (
        "it printed: away",
        "it left a process running, which the grader ended",
    )
    assert made.cents == score.check.cents


def test_the_seconds_of_a_homework_are_those_that_are_calculated(asked, tmp_path):
    """The first step sleeps for longer than that, the second calculates without an end."""
    homework, _, [score] = asked("steps: {scenes: [square]}", head="limits: {seconds: 0.5}")
    file = tmp_path / "mine.py"
    second = "while os.path.exists('begun'): pass\nopen('begun', 'w').close()\ntime.sleep(1)"
    file.write_text(doing(second))
    made = Examiner(homework).examine(score.check, Submission(file, "anna"))
    assert made.words == (
        "the code failed: mine.py:6: step 3 (move 3 m, 90°): took longer than 0.5 s of CPU",
        "it fails at 5 more steps",
        "1 of 4 moves are right",
        "1 of 4 readings are right",
    )
    assert made.cents == score.check.cents // 4


def endless():
    while True:
        os.path.exists("nothing")  # in which no OSError is heard of


def test_so_are_those_of_a_student_s_inputs():
    with at_most(0.1):
        time.sleep(0.2)
    with pytest.raises(TimeOverError), at_most(0.1):
        endless()
