import sys

import pytest
from student.sandbox.broken import doing

from ekfsim.student.grading.examining import Examiner
from ekfsim.student.grading.submissions import Submission

STAYS = """\
if u[0] and not os.path.exists("begun"):
    open("begun", "w").close()
    print("away")
    if os.fork() == 0:
        os.setsid()
        os.close(1)
        os.close(2)
        time.sleep(60)"""


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
