"""A simulated drive, written as a log with named columns and read with the world that it brings,
gives the numbers of the drive itself, whoever drives.
"""

import warnings

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.files.logs import write_log
from ekfsim.localization import play
from ekfsim.simulation import simulate
from ekfsim.systems.estimating import Estimating

MARKS = [{"id": n, "x": x, "y": y} for n, x, y in ((6, 3, 2), (2, 4, -3), (9, -2, 4))]
CLOSET = [[-1, -1], [3, -1], [3, 3], [-1, 3]]
AROUND = {"path": "circle", "radius": 2, "speed": 1, "laps": 0.4}
START = {"x": 0.0, "y": 0.0, "theta": 10}
MOUNT = {"x": 0.3, "y": -0.1, "theta": 33.3}
SEEN = {"range": 9, "views": [[-100, 100]]}
WORLDS = {
    "mower": {"sensors": [{"markers": {"rate": 2, **SEEN}}], "landmarks": MARKS},
    "mower by its wheels": {
        "system": "mower",
        "robot": {"odometry": "midpoint", "estimate": {"wheelScale": {"sigma": 0.05}}},
        "sensors": [
            {"markers": {"name": "front", "rate": 2, "mount": MOUNT, "delay": 0.25}},
            {"markers": {"rate": 1, **SEEN}},
            {"compass": {"orientation": 12.3}},
        ],
        "landmarks": MARKS,
    },
    "pioneer": {"boundary": CLOSET},
    "pioneer on skids": {
        "system": "pioneer",
        "boundary": CLOSET,
        "obstacles": [
            {"name": "bin", "circle": {"x": 2, "y": 2, "radius": 0.2}},
            {"name": "box: a", "points": [[0, 2], [1, 2], [1, 2.5]]},
        ],
        "walls": [[[2, 0], [3, 0.5]], {"name": "panel", "points": [[0, -1], [0, -0.4]]}],
        "robot": {"odometry": "skidSteer"},
        "sensors": [
            {"infrared": {"mount": MOUNT, "bearings": [0, 90, 200]}},
            {"ultrasonic": {"delay": 0.2, "rate": 1}},
            {"gyro": {"name": "yaw-of-it", "rate": 5}},
            {"compass": {}},
        ],
        "belief": {"missing": ["bin"], "start": {"x": 0.1}, "sigma": {"theta": 3}},
    },
    "gnss": {},
    "two receivers": {
        "system": "gnss",
        "robot": {"estimate": {"leftScale": {"sigma": 0.02}, "rightScale": {"sigma": 0.02}}},
        "sensors": [
            {"gnss": {"name": "b", "mount": {"x": -0.5}, "rate": 3, "sigma": 0.1}},
            {"gnss": {"rate": 4, "delay": 0.1}},
        ],
        "belief": {"sensors": {"gnss": {"sigma": 0.3}}, "robot": {"halfTrack": 0.3}},
        "faults": {"leftScale": 1.02, "sensors": {"b": {"xBias": 0.5}}},
        "expectedPath": CLOSET,
    },
    "pylon": {"landmarks": MARKS[:1]},
    "two pylons": {"system": "pylon", "landmarks": MARKS[:2]},
    "pylon by its lidar": {
        "system": "pylon",
        "robot": {"rate": 20, "estimate": {"yawBias": {"sigma": 2}}},
        "sensors": [{"lidar": {"rate": 3, "mount": MOUNT, "delay": 0.05}}],
        "landmarks": MARKS[:2],
        "start": {**START, "sigma": {"x": 0.1, "y": 0.2}},
    },
    "landmarks": {"landmarks": MARKS, "sensors": [{"rangeBearing": SEEN}]},
    "landmarks by several": {
        "system": "landmarks",
        "robot": {"estimate": {"gyroBias": {"sigma": 0.5, "drift": 0.01}}},
        "sensors": [
            {"rangeBearing": {"name": "rear", "mount": {"theta": 180}}},
            {"rangeBearing": {"delay": 0.1}},
            {"bearing": {**SEEN, "rate": 4}},
            {"gnss": {"rate": 1, "sigma": 0.3}},
        ],
        "landmarks": MARKS,
    },
    "ranges": {"landmarks": MARKS, "sensors": [{"range": {"sigma": 0.1}}]},
    "ranges by two": {
        "system": "ranges",
        "sensors": [
            {"range": {"name": "left", "mount": {"y": 0.5}, "scale": 1.1, "sigma": 0.1}},
            {"range": {"mount": {"y": -0.5}, "bias": 0.3, "sigma": 0.2}},
        ],
        "landmarks": MARKS,
    },
}


def scene_of(name, **more):
    world = {"name": "test", "system": name, "start": START, **WORLDS[name]}
    return load_scene({"drive": AROUND, "seed": 5, **more}, world)


def again(folder, reading="corrected", **more):
    """The scene of a log that brings its world, and what is told of it."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scene = load_scene(
            {"recording": {"format": "log", "path": str(folder)}, **more}, reading=reading
        )
    return scene, [str(one.message) for one in told]


def assert_alike(run, log):
    """The same entries, and the same filter upon them."""
    assert len(run) == len(log)
    assert sum(step.correction is not None for step in run) > 5
    for a, b in zip(run, log, strict=True):
        assert (a.entry.index, type(a.entry.given)) == (b.entry.index, type(b.entry.given))
        assert (a.entry.t, a.entry.judged) == (b.entry.t, b.entry.judged)
        np.testing.assert_allclose(b.entry.truth, a.entry.truth, rtol=0, atol=1e-14)
        np.testing.assert_allclose(b.posterior.mean, a.posterior.mean, rtol=0, atol=1e-11)
        np.testing.assert_allclose(
            b.posterior.covariance, a.posterior.covariance, rtol=0, atol=1e-11
        )
        if a.correction is not None:
            assert a.entry.given.name == b.entry.given.name
            np.testing.assert_allclose(b.correction.nis, a.correction.nis, rtol=1e-7)


@pytest.mark.parametrize("name", WORLDS)
def test_a_run_and_its_log_give_the_same_numbers(tmp_path, name):
    scene = scene_of(name, filter="ukf" if name == "gnss" else "ekf")
    assert write_log(scene, simulate(scene), tmp_path / "log", force=False) == []
    logged, told = again(tmp_path / "log", filter=scene.filter)
    assert [one for one in told if "a gap of" not in one] == []
    assert isinstance(logged.world.told_robot, Estimating) == ("estimate" in str(WORLDS[name]))
    assert_alike(list(play(scene)), list(play(logged)))


@pytest.mark.parametrize("reading", ["coded", "printed"])
@pytest.mark.parametrize("name", ["mower", "pylon"])
def test_so_they_do_in_every_reading_of_the_document(tmp_path, name, reading):
    scene = load_scene({"drive": AROUND, "world": name}, name, reading=reading)
    write_log(scene, simulate(scene), tmp_path / "log", force=False)
    run, log = list(play(scene)), list(play(again(tmp_path / "log", reading)[0]))
    assert len(run) == len(log)
    np.testing.assert_allclose(log[-1].posterior.mean, run[-1].posterior.mean, rtol=0, atol=1e-11)


@pytest.mark.parametrize("name", ["landmarks by several", "pylon by its lidar", "mower"])
def test_a_log_without_its_truth_gives_the_same_estimates(tmp_path, name):
    scene = scene_of(name)
    write_log(scene, simulate(scene), tmp_path / "log", force=False)
    (tmp_path / "log/truth.csv").unlink()
    logged, told = again(tmp_path / "log")
    unknown = "no truth.csv and no truth.tum in it: the truth is unknown, and so are the errors"
    first, start = (one for one in told if "a gap of" not in one)
    assert first == f"{tmp_path / 'log'}: {unknown}"
    assert start.startswith(f"{tmp_path / 'log'}: starts at (0, 0, 10°) as told, to within ")
    for a, b in zip(play(scene), play(logged), strict=True):
        np.testing.assert_allclose(b.posterior.mean, a.posterior.mean, rtol=0, atol=1e-11)


def test_readings_that_repeat_are_no_readings_that_are_held(tmp_path):
    """Of a receiver without noise on a robot that stands, and of beams that see walls alike."""
    standing = [{"v": 0, "omega": 0, "for": 3}, {"v": 1, "omega": 10, "for": 1}]
    exact = {"sigma": 0, "sigmaPerMetre": 0}
    square = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    for world in (
        {"system": "gnss", "sensors": [{"gnss": {"sigma": 0}}]},
        {"system": "pioneer", "boundary": square, "sensors": [{"ultrasonic": exact}]},
    ):
        world = {"name": "test", "start": {"x": 0, "y": 0, "theta": 0}, **world}
        scene = load_scene({"drive": standing}, world)
        write_log(scene, simulate(scene), tmp_path / world["system"], force=False)
        logged, told = again(tmp_path / world["system"])
        assert told == []
        assert_alike(list(play(scene)), list(play(logged)))


def test_a_drive_without_a_sensor_or_a_sight_is_a_log_too(tmp_path):
    start = {"x": 0, "y": 0, "theta": 0}
    for name, sensors in ("none", []), ("blind", [{"rangeBearing": {"range": 0.1}}]):
        world = {
            "name": "test", "system": "landmarks", "start": start, "landmarks": MARKS,
            "sensors": sensors,
        }  # fmt: skip
        scene = load_scene({"drive": AROUND}, world)
        write_log(scene, simulate(scene), tmp_path / name, force=False)
        logged, told = again(tmp_path / name)
        assert [one.partition(": ")[2] for one in told] == [
            "no reading is left: the filter follows the motion alone"
        ]
        run, log = list(play(scene)), list(play(logged))
        assert len(run) == len(log)
        np.testing.assert_allclose(log[-1].posterior.mean, run[-1].posterior.mean, atol=1e-12)


def test_ranges_that_a_reader_leaves_out_are_told(tmp_path):
    world = {
        "name": "test", "system": "ranges", "start": {"x": 0, "y": 0, "theta": 0},
        "landmarks": [{"id": 1, "x": 0.1, "y": 0.1}],
    }  # fmt: skip
    scene = load_scene({"drive": [{"v": 0.1, "omega": 0, "for": 5}]}, world)
    (told,) = write_log(scene, simulate(scene), tmp_path / "log", force=False)
    logged, _ = again(tmp_path / "log")
    missed = len(list(play(scene))) - len(list(play(logged)))
    assert told.startswith(f"{missed} readings have ranges of 0 m or less")


def test_the_files_are_text_with_units_and_shortest_numbers(tmp_path):
    scene = scene_of("mower by its wheels")
    write_log(scene, simulate(scene), tmp_path / "log", force=False)
    heads = {
        file.name: file.read_text().splitlines()[:2] for file in (tmp_path / "log").glob("*.csv")
    }
    assert heads["motion.csv"] == ["t [s],left [m],right [m],omega [rad/s]", "0.0,0.0,0.0,0.0"]
    assert heads["readings.csv"][0] == (
        "t [s],sensor,target,azimuth [rad],elevation [rad],yaw [rad]"
    )
    assert heads["landmarks.csv"] == ["id,x [m],y [m]", "6,3.0,2.0"]
    assert heads["truth.csv"][0] == "t [s],x [m],y [m],theta [rad]"
    told = (tmp_path / "log/world.yaml").read_text()
    assert "mount: {x: 0.3, y: -0.1, theta: 33.3}" in told
    assert "orientation: 12.3" in told
    assert "estimate: {wheelScale: {sigma: 0.05, drift: 0.0}}" in told
