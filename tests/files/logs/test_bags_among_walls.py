"""Bags of a robot with scanners among walls; its rays are cast by shapely."""

import math

import numpy as np
import pytest
from bags import Messages, written
from log_worlds import errors
from shapely.geometry import LineString, Polygon

from ekfsim.errors import UsageError
from ekfsim.files.logs.bags.scans import beams_in
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import posed
from ekfsim.localization import play
from ekfsim.records import Control, Reading
from ekfsim.systems.instruments import Ultrasonic

BEGIN = 1_700_000_000.0  # s
OUTLINE = [[-3, -2], [5, -2], [5, 3], [2, 3.5], [-3, 2.5]]
ROOM = Polygon(OUTLINE).exterior
STEP = 0.1  # s
FRONT = {"x": 0.2, "y": -0.05, "theta": 30}
REAR = {"x": -0.25, "y": 0.1, "theta": 180}
OFF = {"x": 0.08, "y": -0.06, "theta": 4}  # where the filter believes it starts


def way():
    """True poses on an arc, at a pace of 0.4 m/s : (n, 3)"""
    t = np.arange(80) * STEP
    return np.column_stack([2 * np.sin(0.2 * t), 2 - 2 * np.cos(0.2 * t) - 1, 0.2 * t])


def cast(pose, mount, bearing, far=30.0):
    """How far it is to the first wall from a scanner on a robot."""
    x, y, θ = pose
    at = complex(x, y) + complex(mount["x"], mount["y"]) * complex(math.cos(θ), math.sin(θ))
    a = θ + math.radians(mount["theta"]) + bearing
    ray = LineString(
        [(at.real, at.imag), (at.real + far * math.cos(a), at.imag + far * math.sin(a))]
    )
    return ray.intersection(ROOM).distance(ray.interpolate(0))


def scans(make, topic, mount, first=-2.35, beams=136, every=5):
    step = math.radians(2)
    for k, pose in list(enumerate(way()))[::every]:
        ranges = [cast(pose, mount, first + i * step) for i in range(beams)]
        ranges = [math.inf if r > 4 else r for r in ranges]
        t = BEGIN + k * STEP
        yield topic, t + 0.04, make.scan(t, ranges, first=first, step=step, far=4.0)


def drive(make, odometry=way()):  # noqa: B008
    for k, pose in enumerate(odometry):
        yield "/odom", BEGIN + k * STEP, make.odometry(BEGIN + k * STEP, *pose)
    for k, pose in enumerate(way()):
        yield "/truth", BEGIN + k * STEP, make.stamped(BEGIN + k * STEP, *pose)


def room(*sensors):
    return {
        "name": "room",
        "system": "pioneer",
        "boundary": OUTLINE,
        "start": {"x": 0, "y": -1, "theta": 0},
        "sensors": [{"ultrasonic": one} for one in sensors],
        "belief": {"start": {"x": OFF["x"], "y": -1 + OFF["y"], "theta": OFF["theta"]},
                   "sigma": {"x": 0.1, "y": 0.1, "theta": 5}},
    }  # fmt: skip


def sensor(**more):
    return {
        "bearings": [-120, -60, 0, 60, 120],
        "range": 4,
        "sigma": 0.01,
        "sigmaPerMetre": 0,
        **more,
    }


def loaded(path, world, **topics):
    topics = {"motion": "/odom", "truth": "/truth", **topics}
    recording = {"format": "bag", "path": str(path), "topics": topics}
    return load_scene({"recording": recording}, world)


def readings(scene):
    return [entry for entry in scene.log.entries if isinstance(entry.given, Reading)]


def test_a_scanner_mounted_askew_brings_the_filter_to_the_true_poses(tmp_path):
    make = Messages("mcap")
    path = written("mcap", tmp_path / "b", [*drive(make), *scans(make, "/scan", FRONT)])
    scene = loaded(path, room(sensor(mount=FRONT)))
    assert len(readings(scene)) == 16 * 5  # several at each instant
    e = errors(list(play(scene)), scene.world.layout)
    assert np.hypot(*e[0, :2]) > 0.01  # after the first scan alone
    assert (
        np.hypot(*e[-20:, :2].T).max() < 0.015
    )  # of which the document's motion model, along the old heading, is 0.01
    assert np.abs(e[-20:, 2]).max() < math.radians(0.5)
    wrong = loaded(path, room(sensor(mount={**FRONT, "theta": -30})))
    off = [posed(s.posterior, wrong.world.layout).mean for s in play(wrong)]
    assert np.hypot(*(off[-1] - way()[-1])[:2]) > 0.05


def test_each_reading_is_what_shapely_casts_along_its_beam(tmp_path):
    make = Messages("db3")
    path = written("db3", tmp_path / "b", [*drive(make), *scans(make, "/scan", FRONT)])
    for entry in readings(loaded(path, room(sensor(mount=FRONT)))):
        x = np.array(entry.truth)
        r, h = entry.given.z[0], entry.given.sensor.h(x)[0]
        bearing = float(entry.given.name.removeprefix("ultrasonic ").removesuffix("°"))
        assert abs(math.remainder(bearing, 60)) <= 1.01  # of a scanner with a beam each 2°
        expected = cast(x, FRONT, math.radians(bearing))
        expected = expected if expected < 4 else math.nan
        assert h == pytest.approx(expected, abs=1e-4, nan_ok=True)
        assert r == pytest.approx(expected, abs=1e-4, nan_ok=True)


def test_several_scanners_are_told_apart_by_their_names(tmp_path):
    make = Messages("bag")
    both = [*scans(make, "/front", FRONT), *scans(make, "/rear", REAR)]
    path = written("bag", tmp_path / "b", [*drive(make), *both])
    world = room(sensor(name="f", mount=FRONT), sensor(name="r", mount=REAR))
    named = [{"topic": "/front", "sensor": "f"}, {"topic": "/rear", "sensor": "r"}]
    scene = loaded(path, world, scan=named)
    assert {entry.given.name.split()[0] for entry in readings(scene)} == {"f", "r"}
    e = errors(list(play(scene)), scene.world.layout)
    assert (
        np.hypot(*e[-20:, :2].T).max() < 0.015
    )  # of which the document's motion model, along the old heading, is 0.01
    with pytest.raises(UsageError, match="several sensors for /front: f, r; say which"):
        loaded(path, world, scan="/front")
    with pytest.raises(UsageError, match="has no sensor g; it has f, r"):
        loaded(path, world, scan={"topic": "/front", "sensor": "g"})


def test_beams_of_one_turn_count_at_their_own_instants():
    make = Messages("mcap")
    scan = make.scan(0, [1.0, 5.0, 0.2, 3.0], first=0.0, step=1.0)
    sensor = Ultrasonic(bearings=(0.0, 1.0, 2.0, 3.0, -1.0), nearest=0.3, farthest=4.0)
    scan.time_increment = 0.01
    found = beams_in([(100, scan)], sensor)
    assert found.rows == [(100, 0.0, 1.0), (10_000_100, 1.0, math.inf), (30_000_100, 3.0, 3.0)]
    told = "\n".join(found.told)
    assert "1 of 3 beams met a wall beyond 4 m" in told
    assert "nearer than 0.3 m" in told
    assert "no scan tells of ultrasonic's beams at -57.3°" in told
    scan.time_increment = 5.0  # which no scanner takes
    assert {row[0] for row in beams_in([(100, scan)], sensor).rows} == {100}


def test_an_odometry_that_begins_anew_is_laid_on(tmp_path):
    make, begun = Messages("mcap"), way()
    c, s = math.cos(-begun[40, 2]), math.sin(-begun[40, 2])
    off = begun[40:] - begun[40]
    begun[40:] = np.column_stack(
        [c * off[:, 0] - s * off[:, 1], s * off[:, 0] + c * off[:, 1], off[:, 2]]
    )
    rows = [
        (topic, t, message)
        for (topic, t, message) in drive(make, begun)
        if topic == "/truth" or not setattr(message.twist.twist.linear, "x", 0.4)
    ]
    for _, _, message in rows[:80]:
        message.twist.twist.angular.z = 0.2
    path = written("mcap", tmp_path / "b", [*rows, *scans(make, "/scan", FRONT)])
    scene = loaded(path, room(sensor(mount=FRONT)))
    controls = [entry.given for entry in scene.log.entries if isinstance(entry.given, Control)]
    left, right = np.array([control.u[:2] for control in controls]).T
    assert len(controls) == 79
    np.testing.assert_allclose(left, left[0], rtol=0.01)
    np.testing.assert_allclose(right, right[0], rtol=0.01)
