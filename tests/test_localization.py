import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from scenes import SILENT, rich, scene, told

from ekfsim.commands import Move, Say, Sense
from ekfsim.diagnostics.ambiguity import remark
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.ekf import EKF
from ekfsim.localization import advance, first_belief, localize, play
from ekfsim.records import Control, Entry, Reading
from ekfsim.simulation import simulate


def test_each_step_begins_with_the_belief_the_last_ended_with():
    steps = list(play(rich()))
    for before, after in pairwise(steps):
        assert after.prior is before.posterior


def test_the_first_belief_is_what_the_filter_is_told():
    made = told(scene(), start=np.array([2.0, 3.0, 0.4]), sigma=np.array([0.1, 0.2, 0.3]))
    for axes in ((), (4,)):
        belief = first_belief(made, axes)
        assert belief.mean.shape == (*axes, 3)
        assert (belief.mean == [2.0, 3.0, 0.4]).all()
        assert belief.covariance == pytest.approx(
            np.broadcast_to(np.diag([0.01, 0.04, 0.09]), (*axes, 3, 3))
        )


def test_what_the_filter_is_not_told_leaves_the_belief_alone():
    belief = Gaussian(np.ones(3), np.eye(3))
    step = advance(EKF(), belief, Entry(3, None, np.zeros(3), Say("word")))
    assert step.posterior is belief
    assert step.prediction is step.correction is step.remark is None
    assert step.nees.dof == 3


def test_a_log_without_truth_is_filtered_alike_and_judged_by_no_one():
    made = rich(gate=0.99)
    known = list(play(made))
    recorded = [
        dataclasses.replace(entry, truth=None, command=None, bump=None) for entry in simulate(made)
    ]
    for step, blind in zip(known, localize(recorded, EKF(0.99), first_belief(made)), strict=True):
        assert (step.posterior.mean == blind.posterior.mean).all()
        assert (step.posterior.covariance == blind.posterior.covariance).all()
        assert blind.nees is None


def test_the_truth_reaches_no_belief():
    """Another true world with the same readings: the same beliefs."""
    made = rich()
    lied = [
        dataclasses.replace(e, truth=None if e.truth is None else e.truth + 1)
        for e in simulate(made)
    ]
    for step, other in zip(
        play(made), localize(lied, EKF(made.gate), first_belief(made)), strict=True
    ):
        assert (step.posterior.mean == other.posterior.mean).all()


def test_the_steps_carry_what_their_entries_call_for():
    for step in play(rich()):
        match step.entry.given:
            case Control():
                assert step.prediction is not None
                assert step.correction is step.remark is None
            case Reading():
                assert step.correction is not None
                assert step.remark is not None
                assert step.prediction is None
            case None:
                assert step.prediction is step.correction is step.remark is None


@pytest.mark.parametrize(("guard", "skipped"), [("off", False), ("warn", False), ("skip", True)])
def test_the_guard_skips_only_when_told_to(guard, skipped):
    senses = [s for s in play(rich(gate=None, guard=guard)) if s.correction]
    ambiguous = [s for s in senses if s.remark.ambiguous]
    assert ambiguous
    assert any(s.correction.refused == Refused.GUARD for s in senses) == skipped
    for step in senses:
        if step.correction.refused == Refused.GUARD:
            assert step.remark.ambiguous
            assert step.posterior.covariance == pytest.approx(step.prior.covariance, abs=0)


def test_the_guard_looks_before_the_update():
    """From the prior, not from the posterior."""
    for step in play(rich(gate=None)):
        if step.correction:
            again = remark(step.entry.given.sensor, *step.prior)
            assert again.ambiguous == step.remark.ambiguous
            assert again.incidence == pytest.approx(float(step.remark.incidence), nan_ok=True)


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("shape", [(1,), (3,)])
def test_a_study_has_a_leading_axis(name, shape):
    course = dataclasses.replace(rich(), filter=name)
    for step in play(course, np.arange(*shape)):
        assert step.posterior.mean.shape == (*shape, 3)
        assert step.posterior.covariance.shape == (*shape, 3, 3)
        assert step.nees.value.shape == step.nees.dof.shape == step.nees.impossible.shape == shape
        if step.correction:
            assert step.correction.refused.shape == shape
            assert step.remark is None


def test_a_study_looks_along_a_beam_only_where_the_guard_must_know():
    for step in play(rich(guard="skip"), np.arange(3)):
        if step.correction:
            assert step.remark.ambiguous.shape == (3,)
            assert not (step.remark.ambiguous & (step.correction.refused == Refused.NOT)).any()


def test_the_gate_of_the_scene_is_the_gate_of_the_filter():
    refused = {
        g: sum(s.correction.refused == Refused.GATE for s in play(rich(gate=g)) if s.correction)
        for g in (None, 0.5)
    }
    assert refused[None] == 0 < refused[0.5]


def test_a_robot_without_noise_is_never_wrong():
    for step in play(scene(Move(1.0, 0.5), Sense(0.3), Move(-0.5, 9.0), Sense(1.0), noise=SILENT)):
        assert step.posterior.mean == pytest.approx(step.entry.truth, abs=1e-12)
        assert (step.posterior.covariance == 0).all()
        assert (float(step.nees.value), int(step.nees.dof)) == (pytest.approx(0), 0)
