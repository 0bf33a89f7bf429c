"""A student's filter, made of two functions, against the reference."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scenes import scene, unbounded
from two_functions import Functions, compared, predict, update

from ekfsim.commands import Move, Say, Sense
from ekfsim.localization import filter_of, first_belief, play
from ekfsim.simulation import simulate
from ekfsim.student.asked import Answer
from ekfsim.student.comparing.compare import compare
from ekfsim.student.fault import FaultError

RIGHT = math.radians(90)
WAY = (Move(2.0, RIGHT), Sense(0.0), Say("On."), Move(1.5, -RIGHT), Sense(-RIGHT), Sense(0.3))


def test_right_equations_agree_at_every_step():
    steps = list(compared(scene(*WAY)))
    assert [one.asked.index for one in steps] == [1, 2, 4, 5, 6]
    assert [one.asked.command for one in steps] == [c for c in WAY if not isinstance(c, Say)]
    assert all(one.differences == () for one in steps)
    assert max(one.size for one in steps) < 1e-9


def test_a_difference_is_told_in_deviations_of_the_right_belief():
    def aside(x, P, u, motion):
        x, P = predict(x, P, u, motion)
        x[1] += 0.02
        P[0, 2] = P[2, 0] = P[0, 2] + 0.001
        return x, P

    made = scene(*WAY, sigma=(0.1, 0.2, 0.1))
    first, *_ = compared(made, aside)
    (y, P_xθ), right = first.differences, first.right
    σ = np.sqrt(np.diag(right.covariance))
    assert (y.entry, P_xθ.entry) == ("y", "P_xθ")
    assert y.theirs - y.right == pytest.approx(0.02)
    assert y.right == right.mean[1]
    assert y.size == pytest.approx(0.02 / σ[1])
    assert P_xθ.right == right.covariance[0, 2]
    assert P_xθ.size == pytest.approx(0.001 / (σ[0] * σ[2]))
    assert first.most is (y if y.size > P_xθ.size else P_xθ)


def test_where_nothing_is_uncertain_a_deviation_counts_as_a_micrometre():
    def aside(x, P, u, motion):
        x, P = predict(x, P, u, motion)
        return x + np.array([0, 3e-6, 0]), P + np.diag([0, 0, 2e-12])

    first, *_ = compared(scene(Move(1.0, 0.0), start=(1, 1, 0)), aside)
    assert [(one.entry, pytest.approx(one.size)) for one in first.differences] == [
        ("y", 3.0), ("P_θθ", 2.0)
    ]  # fmt: skip


def test_an_unwrapped_heading_is_right():
    def unwrapped(x, P, u, motion):
        x, P = predict(x, P, u, motion)
        return x + np.array([0, 0, 6 * math.pi]), P

    assert not any(one.differences for one in compared(scene(*WAY), unwrapped))


def test_what_is_not_symmetric_is_a_difference_and_rounding_is_none():
    def lopsided(by):
        def half(x, P, z, sensor):
            x, P = update(x, P, z, sensor)
            P[2, 0] *= 1 + by
            return x, P

        return compared(scene(*WAY), update=half)

    assert not any(one.differences for one in lopsided(1e-14))
    _, read, *_ = lopsided(0.5)
    (only,) = read.differences
    assert only.entry == "P_θx"
    assert only.theirs == pytest.approx(1.5 * only.right)


def test_each_step_begins_with_what_the_student_believed():
    """One wrong step is one difference: the steps after it begin with what came of it."""
    told = []

    def once(x, P, z, sensor):
        told.append(len(told))
        x, P = update(x, P, z, sensor)
        return (x + 0.01, P) if len(told) == 1 else (x, P)

    steps = list(compared(scene(*WAY), update=once))
    assert [bool(one.differences) for one in steps] == [False, True, False, False, False]
    for before, after in pairwise(steps):
        assert (after.asked.x == before.theirs.x).all()
        assert after.asked.earlier.index == before.asked.index
    assert steps[0].asked.earlier is None


def test_the_belief_that_goes_on_is_wrapped_and_symmetric():
    def rough(x, P, u, motion):
        x, P = predict(x, P, u, motion)
        P[0, 1] += 1e-4
        return x + np.array([0, 0, 4 * math.pi]), P

    _, second, *_ = compared(scene(*WAY, sigma=(0.1, 0.1, 0.1)), rough)
    assert -math.pi < second.asked.x[2] <= math.pi
    assert (second.asked.P == second.asked.P.T).all()


@pytest.mark.parametrize("gate", [None, 0.5])
@pytest.mark.parametrize("guard", ["warn", "skip"])
def test_what_the_filter_would_not_use_is_not_handed_over(gate, guard):
    """No echo, no wall, the gate, the guard, S = 0: as the built-in filter has it."""
    made = replace(unbounded(), gate=gate, guard=guard)
    used = [
        step.entry.index
        for step in play(made)
        if step.prediction is not None
        or (step.correction is not None and not step.correction.refused
            and not np.isnan(step.correction.nis))
    ]  # fmt: skip
    everything = sum(1 for entry in simulate(made) if entry.given is not None)
    assert [one.asked.index for one in compared(made)] == used
    assert 0 < len(used) < everything


def test_another_filter_may_be_the_reference():
    made = scene(*WAY, sigma=(0.2, 0.2, 0.3))
    first, *_ = compared(made, against="ukf")
    assert first.differences
    (x, P), _ = filter_of(replace(made, filter="ukf")).predict(
        first_belief(made), first.asked.given.motion, first.asked.given.u
    )
    assert first.right.mean == pytest.approx(x)
    np.testing.assert_allclose(first.right.covariance, P)


def test_a_belief_that_can_be_none_ends_the_comparison():
    def overdone(x, P, z, sensor):
        x, _ = update(x, P, z, sensor)
        return x, P - np.diag([0, 0, 2 * P[2, 2]])

    *_, last = compared(scene(*WAY), update=overdone)
    assert last.asked.index == 2
    assert last.differences
    variance = -last.asked.P[2, 2]
    assert last.unusable == f"its variance of θ is {variance:.6g}, and no variance is negative"

    def crossed(x, P, z, sensor):
        x, P = update(x, P, z, sensor)
        P[0, 1] = P[1, 0] = 1.01 * math.sqrt(P[0, 0] * P[1, 1])
        return x, P

    *_, last = compared(scene(*WAY), update=crossed)
    assert (last.asked.index, last.unusable) == (
        2, "its P has a negative eigenvalue, and is no covariance"
    )  # fmt: skip


def test_a_belief_of_its_own_to_begin_with_is_seen_at_the_start():
    class Identity(Functions):
        def begin(self, x, P):
            return Answer(x, np.eye(3))

    made = scene(*WAY)
    caller = Identity(predict, update)
    start, *steps = compare(simulate(made), first_belief(made), caller, filter_of(made))
    assert (start.asked.index, start.asked.step) == (0, "the start")
    assert [one.entry for one in start.differences] == ["P_xx", "P_yy", "P_θθ"]
    assert (np.eye(3) == steps[0].asked.P).all()
    assert not any(one.differences for one in steps)


def test_code_that_fails_is_told_with_the_step():
    def fails(x, P, z, sensor):
        raise FaultError("mine.py:12", "ValueError: no")

    with pytest.raises(FaultError) as told:
        list(compared(scene(*WAY), update=fails))
    assert str(told.value) == "mine.py:12: step 2 (sense 0°): ValueError: no"
