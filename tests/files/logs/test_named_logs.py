"""Logs of anybody's make: tables whose columns have names."""

import numpy as np
import pytest
from log_worlds import errors, lay, shared, steps_of, table, world

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play

SOME = 1201  # rows of a recorded log
CORNERS = "id,x,y\n1,0,0\n2,8,0\n3,8,6\n4,0,6\n"


def arc(n=21, v=0.5, ω=0.2, dt=0.25):
    """True poses on a circle by the closed form : (n, 4) t, x, y, θ"""
    t = np.arange(n) * dt
    θ = ω * t
    return np.column_stack([t, 2 + v / ω * np.sin(θ), 1 + v / ω * (1 - np.cos(θ)), θ])


def perfect(poses, marks=((0, 0), (8, 0), (8, 6), (0, 6))):
    """Ranges and bearings of the corners, one at each instant but the first."""
    rows = []
    for k, (t, x, y, θ) in enumerate(poses.tolist()[1:]):
        n = k % len(marks)
        dx, dy = marks[n][0] - x, marks[n][1] - y
        rows.append([t, n + 1, float(np.hypot(dx, dy)), float(np.arctan2(dy, dx) - θ)])
    return table("t,target,range,bearing", rows)


def chords(poses):
    """What a robot that drives by the mid-point rule does between the poses : (n, 2) m, rad"""
    step, turn = np.diff(poses[:, 1:3], axis=0), np.diff(poses[:, 3])
    return np.column_stack([np.hypot(*step.T), turn])


MOTIONS = {
    "v,omega": lambda d, T: [d / 0.25, T / 0.25],
    "left,right": lambda d, T: [(d - 0.27 * T) / 0.25, (d + 0.27 * T) / 0.25],
    "distance,turn": lambda d, T: [d, T],
}


def motion_of(columns, poses):
    """A table of the motion: v and omega hold until the next row, all else is since the last."""
    rows = np.column_stack(MOTIONS[columns](*chords(poses).T))
    rows = np.vstack([rows, rows[-1:]]) if columns == "v,omega" else np.vstack([0 * rows[:1], rows])
    return table(f"t,{columns}", np.column_stack([poses[:, 0], rows]).tolist())


@pytest.mark.parametrize("columns", MOTIONS)
@pytest.mark.parametrize("system", ["landmarks", "ranges"])
def test_whatever_tells_a_motion_it_moves_any_robot_alike(columns, system, tmp_path):
    """A circle by the closed form, told in each way, comes out as the circle."""
    if columns == "left,right":
        pytest.skip("the width of these robots is not known")
    poses = arc()
    truth = table("t,x,y,theta", poses.tolist())
    files = {"motion.csv": motion_of(columns, poses), "readings.csv": perfect(poses)}
    log = lay(tmp_path / "log", **files, **{"landmarks.csv": CORNERS, "truth.csv": truth})
    (tmp_path / "w.yaml").write_text(
        f"name: w\nsystem: {system}\nstart: {{x: 0, y: 0, theta: 0}}\n"
        "sensors: [rangeBearing: {}]\n"
    )
    (tmp_path / "c.yaml").write_text("world: w.yaml\nrecording: {format: log, path: log}\n")
    scene = load_scene(tmp_path / "c.yaml")
    steps = list(play(scene))
    assert sum(step.correction is not None for step in steps) == 20
    assert np.abs(errors(steps, scene.world.layout)).max() < 1e-12
    assert max(step.correction.nis for step in steps if step.correction) < 1e-20
    assert log.exists()


def test_a_world_is_made_where_none_is_named(tmp_path):
    poses = arc()
    lay(
        tmp_path / "log",
        **{"motion.csv": motion_of("v,omega", poses), "readings.csv": perfect(poses)},
        **{"landmarks.csv": CORNERS},
    )
    scene = load_scene("log", log=tmp_path / "log")
    assert scene.world.system == "landmarks"
    assert [one.name for one in scene.world.instruments] == ["rangeBearing"]
    assert [(mark.id, mark.x, mark.y) for mark in scene.world.landmarks][1] == (2, 8, 0)


def test_a_log_s_own_world_is_taken(tmp_path):
    poses = arc()
    own = "name: own\nsystem: ranges\nstart: {x: 2, y: 1, theta: 0}\nsensors: [rangeBearing: {}]\n"
    lay(
        tmp_path / "log",
        **{"motion.csv": motion_of("v,omega", poses), "readings.csv": perfect(poses)},
        **{"landmarks.csv": CORNERS, "world.yaml": own},
    )
    assert load_scene("log", log=tmp_path / "log").world.name == "own"


def test_the_gnss_log_reads_alike_in_both_formats(tmp_path):
    there = shared("mower_gnss")
    for own, name in (("wheelspeeds", "motion"), ("gnss", "readings"), ("groundtruth", "truth")):
        lines = (there / f"{own}-1.csv").read_text().splitlines()[:SOME]
        lay(tmp_path / "gnss", **{f"{own}.csv": "\n".join([*lines, ""])})
        lay(tmp_path / "log", **{f"{name}.csv": "\n".join([*lines, ""])})
    theirs, _, _ = steps_of("gnss", tmp_path / "gnss")
    ours, _, _ = steps_of("log", tmp_path / "log", world("gnss"))
    assert len(theirs) == len(ours)
    for a, b in zip(theirs, ours, strict=True):
        np.testing.assert_array_equal(a.posterior.mean, b.posterior.mean)
        np.testing.assert_array_equal(a.posterior.covariance, b.posterior.covariance)
    assert len([step for step in ours if step.correction]) == 57  # fixes until 6 s


def told_of(log, place=None):
    """The mistake that a log is refused with."""
    with pytest.raises(UsageError) as caught:
        steps_of("log", log, place or world("mrclam"))
    return str(caught.value).removeprefix(f"{log}").lstrip("/")


def test_what_is_missing_is_told(tmp_path):
    log = lay(tmp_path / "log", **{"motion.csv": "t,v\n0,1\n1,1\n"})
    assert told_of(log) == (
        "motion.csv:1:1: no column is named as a motion's are; write t,v,omega or t,left,right or "
        "t,distance,turn or t,ax,ay,yaw or t,x,y,theta; found 't', 'v'"
    )
    lay(log, **{"motion.csv": "t,v,omega\n0,1,0\n1,1,0\n"})
    assert told_of(log) == ": no file 'readings*.csv' in it; it would hold the readings"
    lay(log, **{"readings.csv": "t,x,y\n0,1,1\n", "landmarks.csv": CORNERS})
    assert told_of(log) == (
        "readings.csv:1:1: no column is named as the readings of this world's sensors are; write "
        "t,range,bearing; found 't', 'x', 'y'"
    )
    lay(log, **{"readings.csv": "t,range,bearing\n0,1,1\n"})
    assert told_of(log) == (
        "readings.csv:1:1: no column is named 'target'; name what is seen: a landmark's id, or a "
        "beam's number; found 't', 'range', 'bearing'"
    )
