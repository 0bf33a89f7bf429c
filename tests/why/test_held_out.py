"""Scenes of mechanisms that no packaged input holds: benchmarks/why.py scores all of them."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from ekfsim.why import explain

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from held_out import cases
from held_out.cases import verified

CASES = {one.name: one for one in cases()}
SOME = [
    "studio with a pillar",
    "turns told a fifth",
    "laser told ten times",
    "wheels 0.93",
    "carried and turned in the studio",
    "crate that is gone",
    "beams of a scale",
    "turns 0.92 and 0.2 m too far",
]
RUNS = 100


def test_there_are_many_of_every_mechanism():
    assert len(CASES) > 90
    assert len({one.mechanism for one in CASES.values()}) > 20
    assert len(list(cases())) == len(CASES)


@pytest.mark.parametrize("name", SOME)
def test_the_cause_is_shown_and_named(name):
    one = CASES[name]
    shown = verified(one, RUNS)
    assert shown.holds
    found = explain(replace(one.scene, run=shown.run), RUNS)
    causes = found.causes or (found.mechanism,)
    assert " + ".join(sorted(cause.value for cause in causes)) == one.mechanism
    assert found.outcome == one.outcome
