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
    ("given", "command", "told"),
    [
        (MOVED.given, MOVED.command, "step 7 (move 0.3 m, 90°)"),
        (READ.given, READ.command, "step 7 (sense -86°)"),
        (MOVED.given, None, "step 7 (predict)"),
        (Reading(READ.given.sensor, READ.given.z, "marker 3"), None, "step 7 (marker 3)"),
    ],
)
def test_a_step_is_told_by_its_number_and_its_command(given, command, told):
    assert isinstance(given, Control | Reading)
    asked = Asked(np.zeros(3), np.eye(3), given, command=command, index=7)
    assert asked.step == told
