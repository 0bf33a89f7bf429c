import numpy as np
import pytest
from student.sandbox.broken import BROKEN, RIGHT, whole

import ekfsim
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.records import Control
from ekfsim.student.asked import Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.loading import load
from ekfsim.student.sandbox.limits import Limits
from ekfsim.student.sandbox.sandboxed import Sandboxed

SHORT = Limits(seconds=1, cpu_seconds=2)
ASKED = Asked(
    np.array([1.0, 2.0, 0.3]),
    np.eye(3) * 0.1,
    Control(MoveTurn(0.1, 0.1), np.array([1.0, 0.5])),
)


@pytest.fixture
def mine(tmp_path):
    def written(text):
        file = tmp_path / "mine.py"
        file.write_text(text, encoding="utf-8")
        return file

    return written


@pytest.mark.parametrize("name", ["tour", "mower", "pioneer", "gnss", "pylon"])
def test_what_comes_back_is_what_the_same_code_answers_here(name, mine):
    file = mine(RIGHT)
    here = InProcess(load(str(file)))
    steps = [
        step
        for step in ekfsim.play(ekfsim.load_scene(name))
        if step.prediction or (step.correction and not step.correction.refused)
    ][:60]
    with Sandboxed(file) as there:
        for caller in (here, there):
            caller.begin(*steps[0].prior)
        for step in steps:
            asked = Asked(*step.prior, step.entry.given, step.layout.headings)
            mine_, theirs = here.call(asked), there.call(asked)
            assert np.array_equal(mine_.x, theirs.x)
            assert np.array_equal(mine_.P, theirs.P)


def asked_once(caller):
    """A run of one step."""
    caller.begin(ASKED.x, ASKED.P)
    return caller.call(ASKED)


@pytest.mark.parametrize("broken", BROKEN.values(), ids=BROKEN)
def test_a_broken_file_is_told_in_a_line_and_costs_no_more_than_its_limit(broken, mine):
    with Sandboxed(mine(broken.text), limits=SHORT) as caller:
        for _ in range(2):  # nor is it better when it is asked again
            with pytest.raises(FaultError, match=whole(broken.told)):
                asked_once(caller)
