"""Logs of anybody's make: tables whose columns have names."""

from dataclasses import replace

import numpy as np
import pytest
from log_worlds import errors, lay, shared, steps_of, table, world

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.records import Log, Reading

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
        "t,distance,turn or t,x,y,theta or t,ax,ay,yaw; found 't', 'v'"
    )
    lay(log, **{"motion.csv": "t,v,omega\n0,1,0\n1,1,0\n"})
    cure = "found motion.csv; one by another name is told by recording: {readings: [{file: …}]}"
    told = f": no file 'readings*.csv' in it; it would hold the readings; {cure}"
    assert told_of(log) == told
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


def scene_of(folder, world_text, recording):
    """A scene with a recording, and its world, in files of their own."""
    lay(folder, **{"w.yaml": world_text, "c.yaml": f"world: w.yaml\nrecording:\n{recording}"})
    return load_scene(folder / "c.yaml")


LABYRINTH = """\
  format: log
  path: {path}/Indoor_UWB_Input.txt
  motion: {{rows: odom2diff, columns: {{t: 2, left: 3, right: 4}}, width: 0.157, holds: next,
    wheels: speeds}}
  readings: [{{sensor: range, rows: range2, columns: {{t: 2, range: 3, target: 7}}}}]
  landmarks: {{rows: range2, columns: {{id: 7, x: 5, y: 6}}}}
  truth: {{file: Indoor_UWB_GT.txt, rows: point2, columns: {{t: 2, x: 3, y: 4}}}}
"""


def test_the_labyrinth_is_read_by_a_map_of_its_columns(tmp_path):
    """One file with rows of two kinds, anchors in the rows of the ranges, truth without heading:
    independent filters have 0.078 m, at most 0.203 m, and 0.243 m by the wheels alone."""
    place = (
        "name: l\nsystem: ranges\nstart: {x: 1.652, y: 2.219, theta: 180}\n"
        "robot: {distanceDensity: 0.05, headingDensity: 3}\n"
        "sensors: [range: {sigma: 0.15, scale: 1, bias: 0.10}]\n"
    )
    there = shared("labyrinth_uwb")
    scene = scene_of(tmp_path, place, LABYRINTH.format(path=there))
    assert sorted(mark.id for mark in scene.world.landmarks) == [105, 107, 108, 109]
    assert scene.world.landmarks[1][1:] == (-0.02, 2.365)
    steps = list(play(scene))
    e = np.linalg.norm(errors(steps, scene.world.layout)[:, :2], axis=1)
    assert np.sqrt(np.mean(e**2)) == pytest.approx(0.078, abs=0.003)
    assert e.max() == pytest.approx(0.20, abs=0.02)
    assert sum(step.correction is not None for step in steps) == 233


SEEKUR = """\
  format: log
  path: {path}/EKF_DATA_circle.txt
  columns: {{t: time}}
  units: {{t: 0.1}}
  motion: {{columns: {{x: field.O_x, y: field.O_y, theta: field.O_t}}}}
  readings:
    - sensor: gnss
      columns: {{x: field.G_x, y: field.G_y, varianceX: field.Co_gps_x, varianceY: 10}}
"""


FRESH = 907  # fixes, the others repeat them


def withheld(scene, every):
    """The error at the fixes that a filter is not given, which gets every n-th, where these are
    known to 3 cm: RMSE in m, and how many."""
    fixes = [entry for entry in scene.log.entries if isinstance(entry.given, Reading)]
    first = FRESH - len(fixes)
    out = {entry.index for n, entry in enumerate(fixes, first) if n % every}
    kept = tuple(entry for entry in scene.log.entries if entry.index not in out)
    steps = list(play(replace(scene, log=Log(kept, scene.log.first))))
    t = np.array([step.entry.t for step in steps])
    errors = [
        steps[np.searchsorted(t, fix.t, "right") - 1].posterior.mean[:2] - fix.given.z
        for fix in fixes
        if fix.index in out and fix.given.sensor.sigma_x**2 <= 0.0009
    ]
    return float(np.sqrt(np.mean(np.sum(np.square(errors), axis=1)))), len(errors)


def test_the_seekur_is_read_by_a_map_of_its_columns(tmp_path):
    """Names in a comment, a first record of junk, poses of the odometry, fixes that are held until
    the next with variances of their own: independent filters that get every 5th fix have 0.055 m at
    the others, and with every 20th 0.074 m."""
    place = (
        "name: s\nsystem: ranges\nstart: {x: 1.2801, y: -0.524437, theta: 27.2}\n"
        "robot: {distanceDensity: 0.05, headingDensity: 2}\nsensors: [gnss: {}]\n"
    )
    scene = scene_of(tmp_path, place, SEEKUR.format(path=shared("seekur_gps")))
    fresh = sum(isinstance(entry.given, Reading) for entry in scene.log.entries)
    assert fresh in (FRESH, FRESH - 1)  # the first may be where it begins
    first = next(entry for entry in scene.log.entries if isinstance(entry.given, Reading))
    assert (first.given.sensor.sigma_x, first.given.sensor.sigma_y) == (0.01, 0.02)
    assert withheld(scene, 5)[0] == pytest.approx(0.055, abs=0.002)
    assert withheld(scene, 20)[0] == pytest.approx(0.074, abs=0.002)


def test_mrclam_reads_alike_in_both_formats(tmp_path):
    """Its own files, without names and without a copy of them: columns by their numbers."""
    there, folder = shared("mrclam6_robot1"), tmp_path / "log"
    lines = {path.name: path.read_text().splitlines() for path in there.glob("*.dat")}
    few = {name: "\n".join([*rows[:2500], ""]) for name, rows in lines.items()}
    lay(folder, **few)
    barcodes = [row.split() for row in lines["Barcodes.dat"] if not row.startswith("#")]
    subject = {code: number for number, code in barcodes}
    seen = [row.split() for row in lines["Robot1_Measurement.dat"] if not row.startswith("#")]
    rows = [(t, subject[code], r, φ) for t, code, r, φ in seen if int(subject[code]) > 5]
    text = "".join(f"{' '.join(row)}\n" for row in rows)
    lay(folder, **{"seen.txt": text})
    (tmp_path / "c.yaml").write_text(
        "world: landmarks\nrecording:\n  format: log\n  path: log\n  columns: {t: 1}\n"
        "  motion: {file: Robot1_Odometry.dat, columns: {v: 2, omega: 3}}\n"
        "  readings: [{file: seen.txt, columns: {target: 2, range: 3, bearing: 4}}]\n"
        "  landmarks: {file: Landmark_Groundtruth.dat, columns: {id: 1, x: 2, y: 3}}\n"
        "  truth: {file: Robot1_Groundtruth.dat, columns: {x: 2, y: 3, theta: 4}}\n"
    )
    (tmp_path / "m.yaml").write_text("world: landmarks\nrecording: {format: mrclam, path: log}\n")
    ours, theirs = (list(play(load_scene(tmp_path / name))) for name in ("c.yaml", "m.yaml"))
    assert len(ours) == len(theirs) > 2500
    for a, b in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(a.posterior.mean, b.posterior.mean, rtol=0, atol=1e-12)


def test_plaza_reads_alike_in_both_formats(tmp_path):
    there, names = shared("plaza2_mower_ranges"), ("odometry", "ranges", "nodes", "groundtruth")
    for name in names:
        rows = (there / f"{name}.csv").read_text().splitlines()[:500]
        lay(tmp_path / "log", **{f"{name}.csv": "\n".join([*rows, ""])})
    (tmp_path / "c.yaml").write_text(
        "world: ranges\nrecording:\n  format: log\n  path: log\n  turnTruth: always\n"
        "  readings: [{file: ranges.csv}]\n  landmarks: {file: nodes.csv}\n"
        "  truth: {file: groundtruth.csv}\n"
    )
    (tmp_path / "m.yaml").write_text("world: ranges\nrecording: {format: ranges, path: log}\n")
    ours, theirs = (list(play(load_scene(tmp_path / name))) for name in ("c.yaml", "m.yaml"))
    assert len(ours) == len(theirs) > 500
    for a, b in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(a.posterior.mean, b.posterior.mean, rtol=0, atol=1e-12)
    truths = [
        [s.entry.truth for s in steps if s.entry.truth is not None] for steps in (ours, theirs)
    ]
    np.testing.assert_allclose(*truths, rtol=0, atol=1e-12)
