"""What a recorded log tells of its filter: logs of simulated robots, whose truth is taken away."""

import math
from dataclasses import replace

import numpy as np
import pytest
import systems_scenes
from scipy.stats import multivariate_normal
from wrong_drives import faulty, of_sensor, slower, told_robot, told_sensor, told_start

from ekfsim.localization import entries_of, play
from ekfsim.models.protocols import of_rows
from ekfsim.records import Control, Log, Reading
from ekfsim.systems.drives import Square
from ekfsim.views.why.answer import answer
from ekfsim.why import Change, Mechanism, explain
from ekfsim.why.changes.guesses import families
from ekfsim.why.changes.recorded import (
    Louder,
    LouderMotion,
    later,
    louder,
    louder_all,
    louder_motion,
)
from ekfsim.why.explaining import affordable
from ekfsim.why.trying.logs import rows_of
from ekfsim.why.trying.replaying import ending, replayed

BUDGET = 250
# by which the told noises would be true
FACTORS = {
    Mechanism.SENSOR_OVERTRUSTED: 5.0,
    Mechanism.SENSOR_DISTRUSTED: 0.2,
    Mechanism.ODOMETRY_OVERTRUSTED: 10.0,
}


def recorded(scene, truth=False):
    """The run of a scene as a log, mostly without its truth."""
    entries = tuple(entry if truth else replace(entry, truth=None) for entry in entries_of(scene))
    first = scene.world.first_belief(scene.reading)
    return replace(scene, drive=None, log=Log(entries, first, truth), log_source="log.csv")


def moved(scene, name, by):
    """The log with one landmark told elsewhere than where it stands."""
    entries = [
        replace(entry, given=replace(given, sensor=replace(given.sensor, x=given.sensor.x + by)))
        if isinstance(given := entry.given, Reading) and given.name == name
        else entry
        for entry in scene.log.entries
    ]
    return replace(scene, log=replace(scene.log, entries=tuple(entries)))


SQUARE = Square(2.5, 0.5, math.radians(90), laps=3)
landmarks = replace(slower(systems_scenes.landmarks(), 10.0), drive=SQUARE)
gnss = replace(
    slower(systems_scenes.gnss(), 10.0), drive=Square(4.0, 1.0, math.radians(60), laps=2)
)
CASES = {
    Mechanism.SENSOR_OVERTRUSTED: told_sensor(landmarks, range_sigma=0.06, bearing_sigma=0.004),
    Mechanism.SENSOR_DISTRUSTED: told_sensor(landmarks, range_sigma=1.5, bearing_sigma=0.1),
    Mechanism.ODOMETRY_OVERTRUSTED: told_robot(landmarks, heading_density=0.01),
    Mechanism.MOTION_BIAS: faulty(landmarks, gyro_bias=0.4),
    Mechanism.OUTLIERS: of_sensor(landmarks, outliers=0.06, outlier_size=15.0),
    Mechanism.WRONG_START: told_start(systems_scenes.ultrasonic(), 0.25, 0.1, 0.3),
    Mechanism.WHEEL_SCALE: faulty(gnss, left_scale=1.3),
    Mechanism.LATE_READINGS: of_sensor(gnss, delay=0.6),
}


@pytest.mark.parametrize("mechanism", CASES, ids=lambda one: one.value)
def test_what_is_wrong_is_named_without_the_truth(mechanism):
    found = explain(recorded(CASES[mechanism]), budget=BUDGET)
    assert found.outcome in ("over-confident", "over-cautious")
    assert found.mechanism is mechanism
    told = answer(found)
    assert f"Cause: {mechanism.value}" in told
    assert "whose truth is not known" in told
    assert "impossible" not in told
    if mechanism in FACTORS:
        (cure,) = found.cure
        assert float(cure.name.split()[0]) == pytest.approx(FACTORS[mechanism], rel=0.2)


def test_a_landmark_that_is_told_elsewhere_is_named():
    found = explain(moved(recorded(landmarks), "landmark 1", 1.2), budget=BUDGET)
    assert found.mechanism is Mechanism.MISPLACED_LANDMARK
    assert [one.name for one in found.cure] == ["the landmark 1"]


def test_biases_of_many_targets_are_told_by_their_span():
    steps = list(play(recorded(landmarks)))
    of_target = {}
    for step in steps:
        if step.correction is not None and isinstance(step.entry.given, Reading):
            name = step.entry.given.name
            of_target.setdefault(name, []).append(step.correction.innovation)
    means = [np.mean(each, axis=0) for each in of_target.values() if len(each) >= 10]
    (family,) = [one for one in families(steps, None) if "each target" in one.make(1.0).name]
    for often in (1.0, 2.0, 4.0):
        least, most = often * np.min(means, axis=0), often * np.max(means, axis=0)
        spans = [f"{low:+.3g} to {high:+.3g}" for low, high in zip(least, most, strict=True)]
        assert ", ".join(spans) in family.make(often).name


def test_an_honest_log_is_consistent():
    found = explain(recorded(landmarks), budget=BUDGET)
    assert (found.outcome, found.tried) == ("consistent", ())
    assert "nothing to explain" in answer(found)


def test_a_run_that_is_lost_is_told_so_where_the_log_has_a_truth():
    found = explain(recorded(faulty(landmarks, gyro_bias=0.4), truth=True), budget=BUDGET)
    lost = ending(replayed(found.scene, ()))
    assert (found.outcome, found.lost_from) == (lost.outcome, lost.lost_from)
    assert found.mechanism is Mechanism.MOTION_BIAS


def test_the_budget_is_kept():
    found = explain(recorded(CASES[Mechanism.SENSOR_OVERTRUSTED]), budget=50)
    assert found.replays <= 50
    assert found.replays == len(found.tried)


@pytest.mark.parametrize("filter_name", ["ekf", "iekf", "pf"])
def test_a_log_of_a_slow_filter_is_played_again_less_often(filter_name):
    scene = replace(recorded(landmarks), filter=filter_name)
    replays = affordable(scene, 10_000)
    assert replays == {"ekf": 300, "iekf": 100, "pf": 10}[filter_name]
    assert affordable(scene, 10) == 400
    fewer = replace(scene, tuning=replace(scene.tuning, particles=100))
    assert affordable(fewer, 10_000) == {"ekf": 300, "iekf": 100, "pf": 75}[filter_name]


def test_how_far_replays_have_come_is_told_while_they_are_under_way():
    heard = []
    scene = recorded(CASES[Mechanism.SENSOR_OVERTRUSTED])
    found = explain(scene, budget=12, heard=lambda *one: heard.append(one))
    done = [one for one, of, _ in heard if of == 12]
    assert done == sorted(done)
    assert done[-1] == found.replays <= 12
    assert set(done) >= set(range(1, 9))  # of those side by side, too


def test_rows_side_by_side_are_what_each_is_alone():
    scene = recorded(landmarks, truth=True)
    sensor, motion = louder("landmark", 2.0), louder_motion(3.0)
    one = Change("reading", "nothing")
    rows = rows_of(scene, list(scene.log.entries), [one, sensor, motion])
    for row, change in enumerate((one, sensor, motion)):
        steps = list(replayed(scene, (change,)))
        corrections = [step.correction for step in steps if step.correction is not None]
        alone = sum(float(one.nis) for one in corrections)
        assert rows.nis[row] == pytest.approx(alone, rel=1e-9)
        density = sum(
            multivariate_normal.logpdf(one.innovation, cov=one.S) + math.log(2 * math.pi)
            for one in corrections
        )
        assert rows.likelihood[row] == pytest.approx(density, rel=1e-9)
        assert rows.nees[row] == pytest.approx(float(steps[-1].nees.value), rel=1e-9)
    assert len({round(value, 6) for value in rows.nis}) == 3


def test_amcl_whose_crowds_differ_gives_each_row_its_own_noise():
    scene = recorded(systems_scenes.ultrasonic(), truth=True)
    scene = replace(
        scene, filter="amcl", gate=None, tuning=replace(scene.tuning, particles=3000),
        log=replace(scene.log, entries=scene.log.entries[:60]),
    )  # fmt: skip
    changes = Change("reading", "nothing"), louder_motion(30.0), louder_all(3.0)
    rows = rows_of(scene, list(scene.log.entries), changes)
    for row, change in enumerate(changes):
        steps = replayed(scene, (change,))
        corrections = [step.correction for step in steps if step.correction is not None]
        alone = sum(float(one.nis) for one in corrections if not np.isnan(one.nis))
        assert rows.nis[row] == pytest.approx(alone, rel=1e-9)


def test_a_louder_sensor_and_a_louder_motion_of_some_runs_keep_their_factors():
    (_, target), *_ = landmarks.world.targets("corrected")
    loud = Louder(target.sensor, np.array([2.0, 3.0, 5.0]))
    x = np.array([0.0, 0.0, 0.1])
    np.testing.assert_allclose(loud.of_run((1,)).R(x), 9.0 * target.sensor.R(x))
    np.testing.assert_array_equal(of_rows(loud, np.array([0, 2])).factor, [2.0, 5.0])
    one = Louder(target.sensor, np.array(2.0))
    assert one.of_run((1,)) is one
    control = next(one.given for one in entries_of(landmarks) if isinstance(one.given, Control))
    moved = LouderMotion(control.motion, np.array([2.0, 3.0, 5.0])).of_run((2,))
    np.testing.assert_allclose(moved.M(control.u), 25.0 * control.motion.M(control.u))


def test_a_louder_sensor_has_its_factor_squared():
    (_, target), *_ = landmarks.world.targets("corrected")
    x = np.array([[0.0, 0.0, 0.1], [0.2, 0.1, 0.0]])
    loud = Louder(target.sensor, np.array([2.0, 3.0]))
    R = target.sensor.R(x)
    np.testing.assert_allclose(loud.R(x), np.array([4.0, 9.0])[:, None, None] * R)
    np.testing.assert_array_equal(loud.h(x), target.sensor.h(x))


def test_readings_that_come_late_are_sorted_in_where_they_were_taken():
    scene = recorded(landmarks, truth=True)
    change = later("landmark", 0.3)
    before, after = list(scene.log.entries), list(change.of_entries(scene.log.entries))
    assert sorted(one.index for one in before) == sorted(one.index for one in after)
    times = [one.t for one in after]
    assert times == sorted(times)
    was = {one.index: one.t for one in before}
    assert all(
        one.t == pytest.approx(was[one.index] - 0.3 * isinstance(one.given, Reading))
        for one in after
    )
