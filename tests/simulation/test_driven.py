"""Driven robots: what is drawn is what is stated, run by run, whatever stands beside it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.floor import Map
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import driven, simulate
from ekfsim.systems import INSTRUMENTS, SYSTEMS
from ekfsim.systems.drives import Circle, Square, Stretch, Stretches
from ekfsim.systems.instrument import Landmark
from ekfsim.systems.instruments import Bearings, Gnss, Markers, RangeBearings, Ranges, Ultrasonic
from ekfsim.systems.robot import Tick
from ekfsim.systems.robots import Mower
from ekfsim.world import Noise, Told, World

ROOM = Map(np.array([[-3, -3], [3, -3], [3, 3], [-3, 3.0]]))
MARKS = (Landmark(0, 2.5, 0.2), Landmark(4, -1.0, -2.0), Landmark(7, 0.3, 2.0))
CIRCLE = Circle(radius=1.0, speed=0.5, laps=1.0)
STRAIGHT = Stretches((Stretch(0.5, 0.4, 2.0),))
STILL = Stretches((Stretch(0.0, 0.0, 20.0),))
EVERY = pytest.mark.parametrize("name", SYSTEMS)


def scene(
    robot, instruments, drive, marks=MARKS, start=(0.5, -0.4, 0.3), sigma=(0, 0, 0), **settings
):
    start, sigma, noise = np.array(start), np.array(sigma, float), Noise(0, 0, 0, 0, 0)
    told = Told(start, sigma, noise, ROOM)
    made = World(
        "test",
        ROOM,
        start,
        sigma,
        noise,
        told,
        landmarks=marks,
        system="test",
        robot=robot,
        instruments=instruments,
    )
    return Scene(made, drive=drive, **settings)


def of_system(name, drive=CIRCLE, **settings):
    system, marks = SYSTEMS[name], MARKS[:1] if name == "pylon" else MARKS
    return scene(system.robot, system.instruments, drive, marks, **settings)


def controls(entries):
    return [entry for entry in entries if isinstance(entry.given, Control)]


def readings(entries):
    return {
        (entry.t, entry.given.name): entry.given.z
        for entry in entries
        if isinstance(entry.given, Reading)
    }


def noises(played, runs):
    """ν/σ of every reading of every run : {sensor's name: (n, k)}, and R at the mean of the true
    poses."""
    found, R = {}, {}
    for entry in simulate(played, np.arange(runs)):
        if isinstance(entry.given, Reading):
            sensor, z, x = entry.given.sensor, entry.given.z, played.world.layout.state(entry.truth)
            ν = sensor.residual(z, sensor.h(x))
            found.setdefault(entry.given.name, []).append(ν[~np.isnan(ν).any(axis=-1)])
            R[entry.given.name] = sensor.linearize(x)[2][0]
    return {name: np.concatenate(ν) for name, ν in found.items()}, R


@EVERY
def test_a_run_alone_is_that_run_among_others(name):
    played, runs = of_system(name, sigma=(0.1, 0.1, 0.05), seed=5), np.array([0, 3, 1500])
    beside = list(simulate(played, runs))
    for row, run in enumerate(runs):
        alone = list(simulate(replace(played, run=int(run))))
        ours, theirs = controls(alone), controls(beside)
        assert [entry.t for entry in ours] == [entry.t for entry in theirs]
        assert_allclose([e.truth for e in ours], [e.truth[row] for e in theirs], rtol=0, atol=1e-12)
        assert_allclose(
            [e.given.u for e in ours], [e.given.u[row] for e in theirs], rtol=0, atol=1e-12
        )
        seen = {key: z[row] for key, z in readings(beside).items() if not np.isnan(z[row]).all()}
        assert readings(alone).keys() == seen.keys()
        assert seen
        for key, z in readings(alone).items():
            assert_allclose(z, seen[key], rtol=0, atol=1e-12)
        if name == "pylon":
            assert_allclose([e.fix for e in ours], [e.fix[row] for e in theirs], rtol=0, atol=1e-12)


def test_it_does_not_matter_how_many_ticks_are_worked_out_together(monkeypatch):
    played = of_system("pylon")
    at_once = list(simulate(played))
    monkeypatch.setattr(driven, "AT_ONCE", 7)
    for one, other in zip(at_once, simulate(played), strict=True):
        assert (one.index, one.t, one.truth.tolist()) == (
            other.index,
            other.t,
            other.truth.tolist(),
        )
        if isinstance(one.given, Control):
            assert one.given.u.tolist() == other.given.u.tolist()
            assert one.fix.tolist() == other.fix.tolist()


def test_the_motion_is_disturbed_by_the_stated_process_noise():
    """500 runs of 200 ticks: e = the pose after a tick less where the tick leads from the pose
    before it."""
    played = scene(Mower(), (), STRAIGHT)
    truth = np.array([entry.truth for entry in simulate(played, np.arange(500))])
    middle = truth[:-1, :, 2] + 0.4 * 0.01 / 2
    e = (
        truth[1:]
        - truth[:-1]
        - np.stack([0.005 * np.cos(middle), 0.005 * np.sin(middle), 0.004 + 0 * middle], axis=-1)
    )
    e[..., 2] = wrap(e[..., 2])
    e = e.reshape(-1, 3)
    assert_allclose(e.mean(axis=0), 0, atol=2e-4)
    σ = np.sqrt([1e-4, 1e-4, 7.62e-5])
    assert_allclose(np.cov(e.T) / np.outer(σ, σ), np.eye(3), atol=0.02)


@EVERY
def test_the_input_has_the_stated_noise(name):
    """Sample covariance of u over 500 runs, against M."""
    played = of_system(name, STRAIGHT)
    robot, u = played.world.robot, []
    for entry in controls(
        simulate(replace(played, world=replace(played.world, instruments=())), np.arange(500))
    ):
        ideal, M = expected(robot, entry, (0.5, 0.4))
        σ = np.sqrt(np.diagonal(M)) + (np.diagonal(M) == 0)
        u.append((entry.given.u - ideal) / σ)
    C = np.cov(np.concatenate(u).T)
    assert_allclose(C, M / np.outer(σ, σ), atol=0.05)


def expected(robot, entry, motion):
    """What a steady motion gives without noise, and M at it."""
    distance, turn = motion[0] / robot.rate, motion[1] / robot.rate
    before = np.array([0, 0, entry.truth[0, 2] - turn])
    directions = [
        np.array([math.cos(θ), math.sin(θ)])
        for θ in (before[2] + turn / 2, before[2] + 3 * turn / 2)
    ]
    velocities = [motion[0] * direction for direction in directions]
    after = np.array([*(distance * directions[0]), entry.truth[0, 2]])
    tick = Tick(before, after, np.array(distance), np.array(turn), *velocities, 1 / robot.rate)
    u = robot.ideal(tick)
    return u, robot.motion("corrected").M(u)


@pytest.mark.parametrize("kind", INSTRUMENTS)
def test_readings_have_the_stated_noise(kind):
    """Sample covariance of z − h over 300 runs that stand still, against R of each sensor."""
    still = replace(
        SYSTEMS["pylon"].robot if kind == "pylon" else Mower(position_sigma=0.0, heading_sigma=0.0)
    )
    corner, marks = (
        (1.6, -1.7, 0.3),
        (Landmark(0, 2.9, -1.2), *MARKS[1:])[: 1 if kind == "pylon" else 3],
    )
    found, R = noises(scene(still, (INSTRUMENTS[kind](),), STILL, marks, corner), 300)
    assert found
    for name, ν in found.items():
        σ = np.sqrt(np.diagonal(R[name]))
        assert len(ν) >= 3000, name
        assert_allclose(ν.mean(axis=0) / σ, 0, atol=0.06)
        assert_allclose(
            np.cov(ν.T).reshape(R[name].shape) / np.outer(σ, σ), R[name] / np.outer(σ, σ), atol=0.06
        )


def test_what_the_filter_is_told_moves_nothing():
    """Another reading of the document, filter, gate or first belief: the same truth, inputs and
    readings."""
    first = of_system("mower", sigma=(0.1, 0.1, 0.1))
    told = replace(first.world.told, start=np.zeros(3), sigma=np.ones(3))
    other = replace(
        first, filter="ukf", gate=0.9, reading="printed", world=replace(first.world, told=told)
    )
    for one, another in zip(simulate(first), simulate(other), strict=True):
        assert one.truth.tolist() == another.truth.tolist()
        if isinstance(one.given, Control):
            assert one.given.u.tolist() == another.given.u.tolist()
        if isinstance(one.given, Reading):
            assert one.given.z.tolist() == another.given.z.tolist()


def test_a_noise_a_view_or_an_instrument_more_changes_no_other_draw():
    robot = Mower(position_sigma=0.0, heading_sigma=0.0)
    cameras = RangeBearings(rate=4.0, farthest=9.0), Bearings(rate=2.0, farthest=9.0)
    narrow = replace(cameras[0], views=((-0.3, 0.3),), range_sigma=0.6)
    louder = replace(robot, wheel_sigma=0.02)
    one = list(simulate(scene(robot, cameras, STRAIGHT)))
    other = list(simulate(scene(louder, (narrow, cameras[1], Gnss()), STRAIGHT)))
    assert [e.truth.tolist() for e in controls(one)] == [e.truth.tolist() for e in controls(other)]
    ideal = controls(one)[0].given.u[3]
    for a, b in zip(controls(one), controls(other), strict=True):
        wheels = np.array([0.005 - 0.004 * 1.41 / 2, 0.005 + 0.004 * 1.41 / 2])
        assert_allclose(2 * (a.given.u[:2] - wheels), b.given.u[:2] - wheels, rtol=0, atol=1e-15)
        assert a.given.u[3] == b.given.u[3] == ideal
    wide, close = readings(one), readings(other)
    shared = wide.keys() & close.keys()
    assert 3 <= len(shared) < len(wide)
    # the bearing, whose noise is the same
    assert all(wide[key][-1] == close[key][-1] for key in shared)


def test_a_longer_drive_begins_as_the_shorter_one():
    shorter, longer = (
        list(simulate(of_system("ranges", Square(side=1.0, laps=laps)))) for laps in (1, 2)
    )
    assert [e.truth.tolist() for e in shorter] == [e.truth.tolist() for e in longer[: len(shorter)]]


def test_each_instrument_is_read_at_its_own_rate_in_the_order_they_are_listed():
    far = {"farthest": 90.0}
    all_round = ((-math.pi, math.pi),)
    played = scene(
        Mower(), (Markers(rate=0.5, views=all_round, **far), Gnss(rate=40.0), Ranges(rate=3.0)),
        Stretches((Stretch(0.5, 0.0, 6.0),)),
    )  # fmt: skip
    entries = list(simulate(played))
    times = {}
    for entry in entries:
        if isinstance(entry.given, Reading):
            times.setdefault(entry.given.name, []).append(entry.t)
    assert times["marker 4"] == [2.0, 4.0, 6.0]
    assert times["node 0"] == [math.ceil(100 * i / 3 - 1e-6) / 100 for i in range(1, 19)]
    assert len(times["gnss"]) == 240
    # the first tick at or after 25, 50, 75, 100 ms
    assert times["gnss"][:4] == [0.03, 0.05, 0.08, 0.1]
    last = [
        entry.given.name for entry in entries if entry.t == 6.0 and isinstance(entry.given, Reading)
    ]
    assert last == [*(f"marker {m.id}" for m in MARKS), "gnss", *(f"node {m.id}" for m in MARKS)]
    assert [entry.index for entry in entries] == list(range(len(entries)))
    assert [entry.t for entry in controls(entries)] == [tick / 100 for tick in range(1, 601)]


def test_only_what_is_near_and_in_view_is_read():
    """A robot that looks east from the origin: ahead, behind, aside, and too far."""
    marks = Landmark(1, 5, 1), Landmark(2, -5, 1), Landmark(3, 0, 5), Landmark(4, 20, 0)
    played = scene(Mower(position_sigma=0.0, heading_sigma=0.0), (Markers(),), Stretches((Stretch(0,
    0, 2),)), marks,
                   (0, 0, 0))  # fmt: skip
    assert [name for _, name in readings(simulate(played))] == ["marker 1", "marker 2"]


def test_beams_that_meet_nothing_give_no_reading():
    """In a room of 6 × 6 m no ultrasonic beam of 2 m reaches a wall from the middle."""
    played = scene(
        SYSTEMS["pioneer"].robot, (Ultrasonic(),), Stretches((Stretch(0, 0, 2),)), start=(0, 0, 0)
    )
    assert not readings(simulate(played))
    assert readings(
        simulate(replace(played, world=replace(played.world, start=np.array([2.0, 0, 0]))))
    )


def test_the_driver_holds_the_robot_to_its_way():
    """A square under the mower's noise: without him the heading would stray by 5°/√s."""
    played = scene(Mower(), (), Square(side=4.0, speed=1.0, laps=2))
    for entry in simulate(played):
        last = entry.truth
    assert np.abs(last - np.array([0.5, -0.4, 0.3])).max() < 0.5


def test_the_carts_gps_holds_each_fix_for_two_seconds():
    entries = controls(simulate(of_system("pylon", Circle(laps=2.0)), np.arange(300)))
    fixes = np.array([entry.fix for entry in entries])
    fresh = np.flatnonzero(np.any(np.diff(fixes[:, 0], axis=0), axis=-1)) + 1
    assert fresh.tolist() == list(range(20, len(fixes), 20))
    e = np.concatenate([fixes[i] - entries[i].truth[:, :2] for i in [0, *fresh]])
    assert_allclose(np.cov(e.T), np.eye(2) * 0.4**2, atol=0.01)
