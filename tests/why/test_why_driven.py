"""What is wrong with a driven robot is named, and groups side by side are what each is alone."""

import math
from dataclasses import replace

import numpy as np
import pytest
import systems_scenes
from wrong_drives import faulty, of_sensor, slower, told_robot, told_sensor, told_start

from ekfsim.records import Control
from ekfsim.views.why.answer import answer
from ekfsim.views.why.mechanisms import because
from ekfsim.why import Explanation, Mechanism, explain
from ekfsim.why.changes.driven import suspects_of_drive
from ekfsim.why.changes.groups import exact_inputs, groups_of
from ekfsim.why.trying.replaying import ending, replayed
from ekfsim.why.trying.trials import Trials

RUNS = 20  # as few as speak at all


ranges = slower(systems_scenes.ranges(), 4.0)
landmarks = slower(systems_scenes.landmarks(), 10.0)
CASES = {
    Mechanism.WHEEL_SCALE: faulty(ranges, distance_scale=1.4),
    Mechanism.TURN_SCALE: faulty(ranges, turn_scale=0.6),
    Mechanism.MOTION_BIAS: faulty(landmarks, gyro_bias=0.4),
    Mechanism.SENSOR_BIAS: of_sensor(ranges, bias=(2.0,)),
    Mechanism.OUTLIERS: of_sensor(landmarks, outliers=0.5, outlier_size=20.0),
    Mechanism.LATE_READINGS: of_sensor(landmarks, delay=0.5),
    Mechanism.SENSOR_OVERTRUSTED: told_sensor(landmarks, range_sigma=0.06, bearing_sigma=0.004),
    Mechanism.SENSOR_DISTRUSTED: told_sensor(landmarks, range_sigma=1.5, bearing_sigma=0.1),
    Mechanism.WRONG_SENSOR: told_sensor(ranges, scale=1.4),
    Mechanism.ODOMETRY_OVERTRUSTED: told_robot(landmarks, heading_density=0.01),
    Mechanism.WRONG_START: told_start(systems_scenes.ultrasonic(), 0.25, 0.1, 0.3),
    Mechanism.WRONG_EQUATIONS: systems_scenes.pylon(reading="coded"),
}


@pytest.mark.parametrize("mechanism", CASES, ids=lambda one: one.value)
def test_what_is_wrong_is_named(mechanism):
    found = explain(CASES[mechanism], RUNS)
    assert found.outcome != "consistent"
    assert found.mechanism is mechanism
    assert found.cure
    told = answer(found)
    assert f"Cause: {mechanism.value}" in told
    assert "What there is of it" not in told


@pytest.mark.parametrize("scene", [ranges, landmarks])
def test_nothing_is_wrong_and_nothing_is_explained(scene):
    found = explain(scene, RUNS)
    assert (found.outcome, found.mechanism, found.tried) == ("consistent", None, ())


def test_two_at_once_are_both_named():
    scene = faulty(told_sensor(ranges, sigma=0.06), distance_scale=1.8, sensors={})
    found = explain(scene, RUNS)
    assert set(found.causes) == {Mechanism.WHEEL_SCALE, Mechanism.SENSOR_OVERTRUSTED}


@pytest.mark.parametrize("made", systems_scenes.SCENES)
def test_an_exact_motion_is_what_a_robot_without_noise_measures(made):
    scene = made()
    noise = {
        name: 0.0
        for name in ("wheel_sigma", "gyro_sigma", "wheel_ratio", "wheel_floor", "speed_density",
                     "turn_density", "forward_sigma", "lateral_sigma", "yaw_sigma",
                     "distance_density", "heading_density", "position_sigma", "heading_sigma")
        if hasattr(scene.world.robot, name)
    }  # fmt: skip
    quiet = replace(scene, world=replace(scene.world, robot=replace(scene.world.robot, **noise)))
    entries = [step.entry for step in replayed(quiet, ())][:200]
    exact = exact_inputs(entries, quiet.world.robot).of
    moves = [one for one in entries if isinstance(one.given, Control)][:-1]
    assert len(moves) > 10
    for one in moves:
        u = one.given.u.copy()
        if made is systems_scenes.pylon:
            u[2] = exact[one.index][2] + math.remainder(u[2] - exact[one.index][2], math.tau)
        np.testing.assert_allclose(exact[one.index], u, atol=1e-6)


def test_groups_side_by_side_are_what_each_is_alone():
    scene = faulty(landmarks, gyro_bias=0.4)
    trials = Trials(scene, tuple(replayed(scene, ())), 400, None)
    groups = groups_of(trials.steps, scene.world.robot)
    trials.groups(groups)
    kinds = {one.change.kind for one in groups}
    assert kinds == {"reading", "move"}
    assert trials.replays == len(groups) == len(trials.tried)
    tried = {one.change.name: one for one in trials.tried}
    for group in groups[::3]:
        alone = ending(replayed(scene, (group.change,)))
        one = tried[group.change.name]
        assert one.outcome == alone.outcome
        assert one.lost_from == alone.lost_from
        assert one.nees_end == pytest.approx(alone.nees, rel=1e-9)


def test_each_reading_belongs_to_one_stretch_and_one_target():
    steps = tuple(replayed(landmarks, ()))
    readings = {step.entry.index for step in steps if step.correction is not None}
    groups = [one for one in groups_of(steps, None) if one.change.kind == "reading"]
    spans = [one.at for one in groups if one.change.name.startswith("the readings from")]
    assert sum(map(len, spans)) == len(readings)
    assert frozenset().union(*spans) == readings


def test_a_long_run_has_a_budget_of_its_own():
    found = explain(faulty(landmarks, gyro_bias=0.4), 0, 3)
    assert (found.replays, found.budget) == (3, 3)


def test_equations_that_give_the_motion_too_much_are_tried_where_a_run_is_over_cautious():
    """No number that is told need be wrong for it; it is told as the factor that would fit."""
    *_, last = suspects_of_drive(landmarks, "over-cautious")
    assert last.mechanism is Mechanism.ODOMETRY_DISTRUSTED
    was, now = (
        next(one.entry.given for one in replayed(landmarks, changes) if one.prediction is not None)
        for changes in ((), (last.members[0],))
    )
    np.testing.assert_allclose(now.motion.M(now.u), was.motion.M(was.u) / 4)
    for ended in ("lost", "over-confident"):
        names = {one.mechanism for one in suspects_of_drive(landmarks, ended)}
        assert Mechanism.ODOMETRY_DISTRUSTED not in names
    found = Explanation(landmarks, "over-cautious", None, cure=(last.members[1],))
    told = because(found, Mechanism.ODOMETRY_DISTRUSTED)
    assert told.endswith("it would fit with 0.25 times the told noise of the motion")
