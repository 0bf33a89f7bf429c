"""Truth and told are two things: a run is drawn from the truth and its faults, the filter has its
own numbers."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_driven import CIRCLE, EVERY, STILL, STRAIGHT, controls, of_system, readings, scene

from ekfsim.geometry.angles import wrap
from ekfsim.localization import first_belief
from ekfsim.models.protocols import angles
from ekfsim.records import Control, Reading
from ekfsim.simulation import simulate
from ekfsim.systems import INSTRUMENTS, SYSTEMS
from ekfsim.systems.faults import DriveFaults, SensorFaults
from ekfsim.systems.instruments import Gnss, Infrared, Markers, Pylon, Ranges, Ultrasonic
from ekfsim.systems.robots import Mower

STEADY = Mower(wheel_sigma=0.0, position_sigma=0.0, heading_sigma=0.0)
TOLD_ROBOT = {  # a number of each robot, and where it stands in M or Q of its motion
    "mower": ("wheel_sigma", lambda motion, u: math.sqrt(motion.M(u)[0, 0])),
    "pioneer": ("wheel_ratio", lambda motion, u: motion.wheel_ratio),
    "gnss": ("speed_density", lambda motion, u: motion.speed_density),
    "pylon": ("yaw_sigma", lambda motion, u: math.sqrt(motion.M(u)[2, 2])),
    "landmarks": ("distance_density", lambda motion, u: motion.distance_density),
    "ranges": ("heading_density", lambda motion, u: motion.heading_density),
}
SIGMAS = {"markers": "azimuth_sigma", "rangeBearing": "range_sigma"}  # of the others it is sigma


def wrong(played, **faults):
    return replace(played, world=replace(played.world, drive_faults=DriveFaults(**faults)))


def telling(played, robot=None, instruments=None):
    told = replace(played.world.told, robot=robot, instruments=instruments)
    return replace(played, world=replace(played.world, told=told))


def given(entries, kind):
    return [entry.given for entry in entries if isinstance(entry.given, kind)]


@EVERY
def test_a_filter_is_told_another_robot_and_the_run_stays_as_it_is(name):
    played = of_system(name, STRAIGHT, seed=3)
    key, of_motion = TOLD_ROBOT[name]
    true = getattr(played.world.robot, key)
    believed = telling(played, replace(played.world.robot, **{key: 3 * true}))
    one, other = list(simulate(played)), list(simulate(believed))
    assert_allclose([e.truth for e in one], [e.truth for e in other], rtol=0, atol=0)
    for ours, theirs in zip(given(one, Control), given(other, Control), strict=True):
        assert ours.u.tolist() == theirs.u.tolist()
        assert of_motion(ours.motion, ours.u) == pytest.approx(true)
        assert of_motion(theirs.motion, theirs.u) == pytest.approx(3 * true)


@EVERY
def test_a_true_robot_of_other_numbers_moves_the_run_and_not_the_filter(name):
    """The spread of input and truth over 300 runs grows threefold; what the filter is told
    stays."""
    played = telling(of_system(name, STRAIGHT), SYSTEMS[name].robot, ())
    played = replace(played, world=replace(played.world, instruments=()))
    shaken = replace(played, world=replace(played.world, robot=louder(played.world.robot, 3.0)))
    before, after = (list(simulate(scene, np.arange(300))) for scene in (played, shaken))
    for one, other in zip(controls(before)[:1], controls(after)[:1], strict=True):
        assert type(one.given.motion) is type(other.given.motion)
        for of_motion in (lambda motion, u: motion.M(u), lambda motion, u: motion.Q(u)):
            np.testing.assert_array_equal(
                *(of_motion(e.given.motion, one.given.u[0]) for e in (one, other))
            )
    spreads = [
        np.std([e.given.u for e in controls(entries)], axis=1).mean(axis=0)
        for entries in (before, after)
    ]
    noisy = spreads[0] > 1e-9
    assert noisy.any()
    assert_allclose(spreads[1][noisy] / spreads[0][noisy], 3, rtol=0.02)
    truths = [np.std(entries[-1].truth, axis=0)[:2] for entries in (before, after)]
    assert_allclose(truths[1], 3 * truths[0], rtol=0.05, atol=1e-9)
    np.testing.assert_array_equal(first_belief(played).covariance, first_belief(shaken).covariance)


@pytest.mark.parametrize("kind", INSTRUMENTS.values(), ids=list(INSTRUMENTS))
def test_a_filter_is_told_another_R(kind):
    instrument = replace(kind(), farthest=9.0) if kind in (Ultrasonic, Infrared) else kind()
    played = scene(Mower(), (instrument,), STILL)
    key, x = SIGMAS.get(kind.name, "sigma"), played.world.start
    believed = telling(played, None, (replace(instrument, **{key: 5 * getattr(instrument, key)}),))
    ours, theirs = given(simulate(played), Reading), given(simulate(believed), Reading)
    assert ours
    for one, other in zip(ours, theirs, strict=True):
        assert one.z.tolist() == other.z.tolist()
        assert math.sqrt(other.sensor.linearize(x)[2][0, 0]) > 1.4 * math.sqrt(
            one.sensor.linearize(x)[2][0, 0]
        )


@pytest.mark.parametrize("kind", INSTRUMENTS.values(), ids=list(INSTRUMENTS))
def test_a_bias_of_a_sensor_is_in_its_readings_alone(kind):
    """Turned by the yaw where the reading is; no other draw changes."""
    played = scene(STEADY, (kind(),), STILL)
    if kind is Pylon:
        played = of_system("pylon", STILL)
    sensor, yaw = played.world.true_targets()[0][1].sensor, 0.0
    bias = tuple(0.01 * (n + 1) for n in range(len(sensor.outputs)))
    biased = wrong(played, sensors={kind.name: SensorFaults(bias)})
    for one, other in zip(simulate(played), simulate(biased), strict=True):
        assert one.truth.tolist() == other.truth.tolist()
        if isinstance(one.given, Reading):
            e = other.given.z - one.given.z
            for i in angles(sensor.outputs):
                e[i] = wrap(e[i])
            if kind is Pylon:
                assert_allclose(e, turned(bias, yaw), atol=1e-12)
            else:
                assert_allclose(e, bias, atol=1e-12)
            assert other.given.sensor.linearize(other.truth if kind is not Pylon else state(other))[
                2
            ].tolist() == (
                one.given.sensor.linearize(one.truth if kind is not Pylon else state(one))[
                    2
                ].tolist()
            )
        elif isinstance(one.given, Control):
            assert one.given.u.tolist() == other.given.u.tolist()
            yaw = one.given.u[2]


def state(entry):
    return SYSTEMS["pylon"].robot.layout.state(entry.truth)


def turned(v, angle):
    c, s = math.cos(angle), math.sin(angle)
    return c * v[0] - s * v[1], s * v[0] + c * v[1]


FAULTS = [
    ("mower", "left_scale", 0, "scale"), ("mower", "right_scale", 1, "scale"), ("mower",
    "gyro_bias", 2, "bias"),
    ("pioneer", "left_scale", 0, "scale"), ("pioneer", "right_scale", 1, "scale"),
    ("gnss", "left_scale", 0, "scale"), ("gnss", "right_scale", 1, "scale"),
    ("pylon", "forward_bias", 0, "bias"), ("pylon", "lateral_bias", 1, "bias"), ("pylon",
    "yaw_bias", 2, "bias"),
    ("landmarks", "distance_scale", 0, "scale"), ("landmarks", "turn_scale", 1, "scale"),
    ("landmarks", "gyro_bias", 1, "bias"),
    ("ranges", "distance_scale", 0, "scale"), ("ranges", "turn_scale", 1, "scale"),
    ("ranges", "gyro_bias", 1, "rate"),
]  # fmt: skip


def test_every_fault_of_a_robot_is_tried():
    tried = [(system, fault, entry) for system, fault, entry, _ in FAULTS]
    assert tried == [
        (name, *fault) for name, system in SYSTEMS.items() for fault in system.robot.faults.items()
    ]


@pytest.mark.parametrize(("name", "fault", "entry", "kind"), FAULTS)
def test_a_fault_of_the_robot_is_in_its_input_alone(name, fault, entry, kind):
    """A scale multiplies what is right and leaves its noise; a bias comes on top. The truth goes
    its way."""
    played = of_system(name, STRAIGHT, seed=2)
    sound, faulty = (
        list(simulate(played)),
        list(simulate(wrong(played, **{fault: 1.5 if kind == "scale" else 0.25}))),
    )
    quiet = replace(played, world=replace(played.world, robot=silent(played.world.robot)))
    right = [e.given.u for e in controls(simulate(quiet))]
    for one, other, ideal in zip(controls(sound), controls(faulty), right, strict=True):
        assert one.truth.tolist() == other.truth.tolist()
        e = other.given.u - one.given.u
        if kind == "bias":
            assert e[entry] == pytest.approx(0.25)
        elif kind == "rate":  # of a turn, which adds up over the time of the input
            assert e[entry] == pytest.approx(0.25 * one.given.u[2])
        # there the truth is disturbed, and the driver steers back
        elif name != "gnss" and name != "mower":
            assert e[entry] == pytest.approx(0.5 * ideal[entry], rel=1e-9, abs=1e-12)
        assert e[entry] != 0
        assert np.delete(e, entry) == pytest.approx(0)
    assert {key: z.tolist() for key, z in readings(sound).items()}.keys() == readings(faulty).keys()


def silent(robot):
    """A robot without noise."""
    return louder(robot, 0.0)


def louder(robot, times):
    """A robot with all its noises so many times as large."""
    spreads = ("sigma", "ratio", "floor", "density")
    return replace(
        robot, **{key: times * value for key, value in vars(robot).items() if key.endswith(spreads)}
    )


def test_outliers_come_as_often_and_as_large_as_said():
    played = scene(STEADY, (Gnss(rate=100, sigma=0.2),), STILL)
    noisy = wrong(played, sensors={"gnss": SensorFaults(outliers=0.2, outlier_size=50)})
    sound, struck = (np.array([r.z - played.world.start[:2] for r in given(simulate(s,
    np.arange(8)), Reading)])
                     for s in (played, noisy))  # fmt: skip
    same = (sound == struck).all(axis=-1)
    # of 16 000 readings: three standard deviations
    assert np.mean(~same) == pytest.approx(0.2, abs=0.01)
    assert_allclose(struck[~same], 50 * sound[~same], rtol=1e-9, atol=1e-12)
    assert np.std(sound[same]) == pytest.approx(0.2, rel=0.02)
    alone = [r.z for r in given(simulate(replace(noisy, run=7)), Reading)]
    assert_allclose(alone, struck[:, 7] + played.world.start[:2], rtol=0, atol=1e-12)


@pytest.mark.parametrize("at_once", [100_000, 7])
@pytest.mark.parametrize("delay", [0.3, 0.025])
def test_a_delayed_reading_is_of_what_was_there(delay, at_once, monkeypatch):
    """Between two ticks on the straight line between their poses, before the start at it; whatever
    lies in a block."""
    monkeypatch.setattr("ekfsim.simulation.driven.AT_ONCE", at_once)
    robot = Mower(rate=20, wheel_sigma=0.0, position_sigma=0.02, heading_sigma=0.1)
    markers = Markers(
        rate=10, azimuth_sigma=0, elevation_sigma=0, farthest=50, views=((-math.pi, math.pi),)
    )
    played = scene(robot, (markers, Gnss(rate=20, sigma=0)), CIRCLE, start=(0.5, -0.4, 3.0))
    late = wrong(
        played,
        sensors={"markers": SensorFaults(delay=delay), "gnss": SensorFaults(delay=2 * delay)},
    )
    entries = list(simulate(late, np.arange(3)))
    t = np.array([e.t for e in entries if not isinstance(e.given, Reading)])
    # (T + 1, 3, 3)
    truth = np.array([e.truth for e in entries if not isinstance(e.given, Reading)])
    headings = np.unwrap(truth[..., 2], axis=0)
    for entry in entries:
        if isinstance(entry.given, Reading):
            when = entry.t - (delay if "marker" in entry.given.name else 2 * delay)
            for run in range(3):
                columns = (truth[:, run, 0], truth[:, run, 1], headings[:, run])
                x = np.array([np.interp(max(when, 0), t, column) for column in columns])
                z = entry.given.sensor.h(x)
                assert_allclose(entry.given.sensor.residual(entry.given.z[run], z), 0, atol=1e-9)


def test_ranges_are_corrected_as_the_filter_s_side_is_told():
    played = scene(STEADY, (Ranges(scale=1.2, bias=0.3),), STILL)
    told = telling(played, None, (Ranges(scale=1.0, bias=0.1),))
    for one, other in zip(
        given(simulate(played), Reading), given(simulate(told), Reading), strict=True
    ):
        assert other.z == pytest.approx(1.2 * one.z + 0.2)


def test_a_wall_of_another_colour_than_the_filter_is_told():
    played = scene(STEADY, (Infrared(colour="black", farthest=5),), STILL)
    told = telling(played, None, (Infrared(colour="white", farthest=5),))
    x = played.world.start
    black, white = (given(simulate(s), Reading)[0] for s in (played, told))
    assert white.z.tolist() == black.z.tolist()
    assert abs(white.sensor.h(x)[0] - black.sensor.h(x)[0]) > 0.2


def test_by_gyro_or_by_wheels_on_one_and_the_same_drive():
    """Eq. 20 in place of the gyro: the same truth and the same ways, and no bias of the gyro gets
    in."""
    played = scene(Mower(), (), STRAIGHT, seed=4)
    by_wheels = telling(played, Mower(odometry="midpoint"))
    both = replace(played, world=replace(played.world, robot=Mower(odometry="midpoint")))
    gyro = controls(simulate(wrong(played, gyro_bias=0.1)))
    for scene_of_wheels in (by_wheels, both, wrong(both, gyro_bias=0.1)):
        for one, other in zip(gyro, controls(simulate(scene_of_wheels)), strict=True):
            assert one.truth.tolist() == other.truth.tolist()
            assert one.given.u[:2].tolist() == other.given.u[:2].tolist()
            assert other.given.motion.f(np.zeros(3), np.array([0.0, 1.41, 9.0, 1.0]))[
                2
            ] == pytest.approx(1.0)


def test_noise_of_the_gyro():
    played = scene(Mower(gyro_sigma=0.2), (), STRAIGHT)
    ω = np.array([e.given.u[:, 2] for e in controls(simulate(played, np.arange(200)))])
    assert ω.std() == pytest.approx(0.2, rel=0.02)
