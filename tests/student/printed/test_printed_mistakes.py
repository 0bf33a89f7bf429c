"""Tables of results with known mistakes, with six digits: each is found, and named."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import filter_of, first_belief
from ekfsim.records import Control
from ekfsim.simulation import simulate
from ekfsim.student.asked import Answer
from ekfsim.student.comparing.compare import compare
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mutant import Mutant
from ekfsim.student.printed.held import held_table

NAMES = "index,x,y,theta,p11,p12,p13,p21,p22,p23,p31,p32,p33"
SOME = KNOWN[::8]
LIKE = {"radians-twice"}  # of which degrees-in-f makes the same in a tour's numbers


@pytest.fixture(scope="module")
def scene():
    return load_scene("tour")


def written(path, steps, digits=6):
    lines = [NAMES]
    for step in steps:
        x, P = step.theirs
        numbers = [x[0], x[1], math.degrees(x[2]), *P.ravel()]
        lines.append(",".join([f"{step.asked.index}", *(f"{n:.{digits}g}" for n in numbers)]))
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("mistake", SOME, ids=[one.name for one in SOME])
def test_a_known_mistake_is_found_and_named(scene, mistake, tmp_path):
    def steps():
        return compare(simulate(scene), first_belief(scene), Mutant(mistake), filter_of(scene))

    first = next((step for step in steps() if step.differences), None)
    found = held_table(scene, written(tmp_path / "theirs.csv", steps()), "ekf").found
    assert (found.first is None) == (first is None)
    if first is not None:
        assert found.first.step.asked.index == first.asked.index
        assert mistake.name in LIKE or any(guess == (mistake,) for guess in found.guesses)


@pytest.mark.parametrize("digits", [4, 6, 9])
@pytest.mark.parametrize("run", range(4))
def test_right_results_are_never_called_wrong(scene, run, digits, tmp_path):
    """Other runs, whose beams meet corners and other walls as well."""
    one = replace(scene, run=run, seed=77)
    steps = compare(simulate(one), first_belief(one), _Right(), filter_of(one))
    found = held_table(one, written(tmp_path / "theirs.csv", steps, digits), "ekf").found
    assert found.first is None
    assert found.steps > 20


class _Right:
    """Answers with the textbook's equations, written anew."""

    def begin(self, x, P):
        """It keeps nothing."""

    def call(self, asked):
        x, P, given = asked.x, asked.P, asked.given
        if isinstance(given, Control):
            F, G = given.motion.F(x, given.u), given.motion.G(x, given.u)
            return Answer(
                given.motion.f(x, given.u), F @ P @ F.T + G @ given.motion.M(given.u) @ G.T
            )
        H = given.sensor.H(x)
        K = P @ H.T @ np.linalg.inv(H @ P @ H.T + given.sensor.R(x))
        return Answer(x + K @ (given.z - given.sensor.h(x)), (np.eye(3) - K @ H) @ P)
