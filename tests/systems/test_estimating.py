"""A filter that is asked to finds a bias beside the pose, as surely as it says."""

import math
from collections import deque
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.stats

from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import load_scene, read_scene
from ekfsim.files.scenes.settings import setting
from ekfsim.filters import FILTERS
from ekfsim.localization import play
from ekfsim.records import Control
from ekfsim.systems.faults import DriveFaults
from ekfsim.twins import taking

PLAZA = Path(__file__).parents[3] / "shared/data/plaza2_mower_ranges"
HEAD = """
name: room
start: {x: 0, y: 0, theta: 20}
landmarks: [{id: 1, x: 6, y: 3}, {id: 2, x: -5, y: 5}, {id: 3, x: 1, y: -7}]
"""
SENSOR = "sensors: [{rangeBearing: {rate: 1, rangeSigma: 0.2, range: 30, views: [[-180, 180]]}}]\n"
ROBOT = "robot: {rate: 4, headingDensity: 1"  # degrees per √s: a gyro that is worth a bias
# gyro bias 1.5 σ, wheel scale 1 σ from what is believed
FAULTY = "faults: {gyroBias: 1.5, distanceScale: 1.05}\n"
ESTIMATE = ", estimate: {gyroBias: {sigma: 1}, wheelScale: {sigma: 0.05}}"
ANYWHERE = [name for name in FILTERS if name != "amcl"]  # which needs a room
DRIVE = {"path": "square", "side": 3, "speed": 1, "turnRate": 45, "laps": 1}
WRONG = np.array([math.radians(1.5), 0.05])


def scene_of(tmp_path, world, name="ekf"):
    file = tmp_path / "world.yaml"
    file.write_text(world, encoding="utf-8")
    told = {"world": str(file), "drive": DRIVE, "filter": name, "seed": 3}
    return load_scene(told)


def landmarks(tmp_path, estimate=ESTIMATE, faults=FAULTY, name="ekf"):
    return scene_of(
        tmp_path, HEAD + "system: landmarks\n" + ROBOT + estimate + "}\n" + SENSOR + faults, name
    )


def last_of(scene, runs):
    (step,) = deque(play(scene, np.arange(runs)), maxlen=1)
    return step


def off(step):
    x, y, _ = np.moveaxis(step.layout.pose(step.posterior.mean) - step.entry.truth, -1, 0)
    return np.hypot(x, y)


def test_the_bias_is_found_within_its_own_sigmas_and_the_pose_is_better_for_it(tmp_path):
    """In 200 runs; the median error of the last position is 0.05 m, 0.09 m without."""
    step, runs = last_of(landmarks(tmp_path), 200), 200
    plain = last_of(landmarks(tmp_path, estimate=""), runs)
    e, P = step.posterior.mean[:, 3:] - WRONG, step.posterior.covariance[:, 3:, 3:]
    sigma = np.sqrt(np.diagonal(P, axis1=-2, axis2=-1))
    assert (np.abs(e) < 3 * sigma).all(axis=-1).mean() >= 0.95
    assert (sigma.mean(axis=0) < 0.4 * np.array([math.radians(1), 0.05])).all()  # it has learnt
    assert np.median(off(step)) < 0.7 * np.median(off(plain))


def test_its_pose_is_as_sure_as_it_says_where_the_faults_are_as_it_believes(tmp_path):
    """In 200 runs, each with biases drawn for it: the mean NEES of the pose is 3."""
    random, draws = np.random.default_rng(8), 200
    scene = landmarks(tmp_path)
    bias, scale = random.normal(0, 1, draws), 1 + random.normal(0, 0.05, draws)
    faults = DriveFaults(gyro_bias=np.radians(bias), distance_scale=scale)  # of each run its own
    step = last_of(replace(scene, world=replace(scene.world, drive_faults=faults)), draws)
    assert (step.nees.dof == 3).all()
    low, high = scipy.stats.chi2.ppf([0.001, 0.999], 3 * draws) / draws
    assert low < np.mean(step.nees.value) < high


@pytest.mark.parametrize("name", [name for name in ANYWHERE if not name.startswith("kf")])
def test_every_filter_finds_it(tmp_path, name):
    step = last_of(landmarks(tmp_path, name=name), 4)
    mean = np.median(step.posterior.mean[:, 3:], axis=0)
    assert step.layout.names[3:] == ("gyro_bias", "wheel_scale_error")
    assert (np.abs(mean - WRONG) < [math.radians(0.6), 0.03]).all()


@pytest.mark.parametrize("name", ANYWHERE)
def test_a_study_s_runs_are_the_run_alone(tmp_path, name):
    """Whichever way the numbers are worked out."""
    scene = landmarks(tmp_path, name=name)
    many, alone = last_of(scene, 3), list(play(scene))[-1]
    with taking("plain"):
        plain = last_of(scene, 3)
    np.testing.assert_allclose(many.posterior.mean[0], alone.posterior.mean, rtol=0, atol=1e-6)
    np.testing.assert_allclose(many.posterior.mean, plain.posterior.mean, rtol=0, atol=1e-6)


def test_what_is_asked_for_is_the_filter_s_alone(tmp_path):
    """Truth and readings are those of the same world without it; its own numbers are told."""
    asked, not_asked = landmarks(tmp_path), landmarks(tmp_path, estimate="")
    for one, other in zip(play(asked), play(not_asked), strict=True):
        assert one.entry.truth.tolist() == other.entry.truth.tolist()
        if isinstance(one.entry.given, Control):
            assert one.entry.given.u.tolist() == other.entry.given.u.tolist()
    first = next(iter(play(asked)))
    np.testing.assert_allclose(
        np.sqrt(np.diag(first.prior.covariance)), [0.01, 0.01, 0.01, math.radians(1), 0.05]
    )


@pytest.mark.parametrize(
    ("system", "estimate", "more"),
    [
        ("mower", "gyroBias: {sigma: 1}, leftScale: {sigma: 0.05}", ""),
        (
            "pioneer",
            "wheelScale: {sigma: 0.05}",
            "boundary: [[-2, -2], [4, -2], [4, 5], [-2, 5]]\n",
        ),
        ("gnss", "leftScale: {sigma: 0.05}, rightScale: {sigma: 0.05}", ""),
        ("pylon", "yawBias: {sigma: 3}, forwardBias: {sigma: 0.1}", ""),
        ("ranges", "gyroBias: {sigma: 1}, turnScale: {sigma: 0.05}", ""),
    ],
)
def test_every_driven_robot_may_be_asked(tmp_path, system, estimate, more):
    world = f"system: {system}\nrobot: {{rate: 10, estimate: {{{estimate}}}}}\n"
    scene = scene_of(tmp_path, HEAD + world + more)
    step = list(play(scene))[-1]
    assert np.isfinite(step.posterior.covariance).all()
    n = len(scene.world.robot.layout.names)
    started = np.diag(scene.world.first_belief("corrected").covariance)
    assert (np.diag(step.posterior.covariance)[n:] < started[n:]).all()
    assert step.nees.dof == 3


def test_belief_adds_to_and_overrules_what_the_robot_says(tmp_path):
    world = (
        HEAD
        + "system: landmarks\n"
        + ROBOT
        + ESTIMATE
        + "}\n"
        + (
            "belief: {robot: {estimate: {wheelScale: {sigma: 0.2, drift: 0.01}, turnScale: "
            "{sigma: 0.1}}}}\n"
        )
    )
    robot = scene_of(tmp_path, world).world.told_robot
    assert [(name, round(one.sigma, 4), one.drift) for name, one in robot.estimates] == [
        ("gyro_bias", round(math.radians(1), 4), 0.0),
        ("wheel_scale", 0.2, 0.01),
        ("turn_scale", 0.1, 0.0),
    ]


@pytest.mark.skipif(not PLAZA.is_dir(), reason="the recorded logs are not here")
def test_it_finds_the_drift_of_a_recorded_gyro():
    """Plaza 2: by the truth its gyro loses 2.2 rad in 410 s (../shared/data/README.md)."""
    settings = [setting("robot.estimate.gyroBias.sigma=1")]
    log, told = str(PLAZA), resolve("ranges_log", "commands")
    (plain,), (found,) = (
        deque(play(read_scene(told, None, log, settings=some).get()), maxlen=1)
        for some in ((), settings)
    )
    assert plain.layout.names == ("x", "y", "theta")
    assert found.posterior.mean[3] * 410 == pytest.approx(-2.2, abs=0.2)
    assert math.sqrt(found.posterior.covariance[3, 3]) < math.radians(0.1)
