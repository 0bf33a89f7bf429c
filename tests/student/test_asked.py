import math

import numpy as np
import pytest
from scenes import scene

from ekfsim.commands import Move, Sense
from ekfsim.records import Control, Reading
from ekfsim.simulation import simulate
from ekfsim.student.asked import Asked

_, MOVED, READ = simulate(scene(Move(0.1 + 0.2, math.radians(90)), Sense(math.radians(-86))))


@pytest.mark.parametrize(
    ("given", "command", "t", "told"),
    [
        (MOVED.given, MOVED.command, None, "step 7 (move 0.3 m, 90°)"),
        (READ.given, READ.command, None, "step 7 (sense -86°)"),
        (MOVED.given, None, 1.5, "step 7 (motion at 1.5 s)"),
        (
            Reading(READ.given.sensor, READ.given.z, "marker 3"),
            None,
            2.0,
            "step 7 (marker 3 at 2 s)",
        ),
    ],
)
def test_a_step_is_told_by_its_number_and_what_it_is(given, command, t, told):
    assert isinstance(given, Control | Reading)
    assert Asked(np.zeros(3), np.eye(3), given, command=command, index=7, t=t).step == told
    assert Asked(np.zeros(3), np.eye(3), given).step == "the start"
