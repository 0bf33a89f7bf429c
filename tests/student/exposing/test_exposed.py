"""The first step at which an input exposes a mistake is that at which a filter with it, run on its
own, leaves the right one."""

import math

import pytest

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.localization import filter_of, first_belief
from ekfsim.simulation import simulate
from ekfsim.student.comparing.compare import compare
from ekfsim.student.exposing.exposed import exposed, possible
from ekfsim.student.exposing.statistics import seen, with_mistake, without_mistake
from ekfsim.student.mistakes.known import BY_NAME, KNOWN
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.mutant import Mutant

NONE = Mistake("none", "", "", lambda _: True, ({},))


def scene(name):
    return read_scene(packaged("commands")[name]).get()


@pytest.mark.parametrize(
    "name", ["tour", "proof-coverage", "proof-corner", "diverge-11-short-returns"]
)
def test_it_is_where_a_filter_with_the_mistake_leaves_the_right_one(name):
    played = scene(name)
    entries, reference = list(simulate(played)), filter_of(played)
    for one in exposed(played):
        steps = compare(entries, first_belief(played), Mutant(one.mistake), reference)
        first = next((step for step in steps if step.differences), None)
        assert (first is None) == (one.first is None), one.mistake.name
        if first is not None:
            assert one.first.asked.index == first.asked.index, one.mistake.name
            assert one.first.most.entry == first.most.entry
            assert one.first.most.size == pytest.approx(first.most.size, rel=1e-3, abs=1e-4)


def test_a_right_filter_is_never_exposed():
    for name in ("tour", "proof-corner", "diverge-01-wrong-wall", "pioneer"):
        (one,) = exposed(scene(name), [NONE])
        assert one.possible
        assert one.first is None


def test_what_can_be_made_is_asked_of_the_robot_not_of_what_it_does():
    moves_alone = possible(scene("proof-distance-noise"), KNOWN)
    assert moves_alone == possible(scene("tour"), KNOWN)
    beyond = {mistake.name for mistake in set(KNOWN) - moves_alone}
    assert beyond == {"no-process-noise", "innovation-not-wrapped", "K-entry-by-entry"}
    shown = {one.mistake.name for one in exposed(scene("proof-distance-noise")) if one.first}
    assert "J_u-exchanged" in shown
    assert "innovation-sign" not in shown


def test_of_a_reading_that_says_nothing_no_mistake_can_be_made():
    """Where S = 0 no filter is handed one."""
    can_be_made = {mistake.name for mistake in possible(scene("proof-no-noise"), KNOWN)}
    assert "turn-before-move" in can_be_made
    assert "innovation-sign" not in can_be_made


def test_a_number_is_told_that_is_wrong_by_hand():
    """A square of 3 m: with the turn first, the first side goes along the second."""
    played = scene("proof-square-twice")
    (one,) = exposed(played, [BY_NAME["turn-before-move"]])
    x, y, θ = played.world.start
    assert θ == 0
    assert one.first.asked.step == "step 2 (move 3 m, 90°)"
    assert one.first.theirs.x == pytest.approx([x, y + 3, math.pi / 2])
    assert one.first.right.mean == pytest.approx([x + 3, y, math.pi / 2])


@pytest.fixture(scope="module")
def tour():
    return scene("tour")


def test_statistics_of_no_mistake_are_those_of_a_study(tour):
    study, ours = without_mistake(tour, 50), with_mistake(tour, NONE, 50)
    assert seen(study) == seen(ours) == ""
    assert study.last.above_50 == ours.last.above_50
    assert study.last.lost == ours.last.lost
    assert study.nis.value == pytest.approx(ours.nis.value, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "above", "lost", "nis", "sees"),
    [  # measured with another program, 100 runs: shares within what so many runs leave open
        ("C_v-of-the-reading", 0.49, 0, 0.98, False),
        ("Jacobians-after-move", 0.53, 0, 1.17, False),
        ("sigma-in-C_v", 0.17, 0, 0.77, True),
        ("innovation-sign", 1.0, 1.0, 802, True),
    ],
)  # fmt: skip
def test_statistics_are_what_was_measured_elsewhere(tour, name, above, lost, nis, sees):
    found = with_mistake(tour, BY_NAME[name], 100)
    assert found.last.above_50.value == pytest.approx(above, abs=0.14)
    assert found.last.lost.value == pytest.approx(lost, abs=0.03)
    assert bool(seen(found)) == sees
    if not sees:
        assert found.nis.value == pytest.approx(nis, abs=0.1)
