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
