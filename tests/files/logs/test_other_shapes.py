"""Logs of other shapes: without times, several readings in a row, dates, places on the earth."""

import math
import warnings
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from log_worlds import errors, lay, table
from test_named_logs import CORNERS, arc, chords, perfect

from ekfsim.errors import UsageError
from ekfsim.files.logs.tables.angles import BEYOND_A_TURN, are_degrees
from ekfsim.files.logs.tables.declared import Column
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play

MARKS = np.array([(0, 0), (8, 0), (8, 6), (0, 6)])
WORLD = "name: w\nsystem: {}\nstart: {{x: 2, y: 1, theta: 0}}\nsensors: [{}]\n"
TABLES = """\
  motion: {{file: log.txt, {motion}}}
  readings: [{{file: log.txt, {readings}}}]
  landmarks: {{file: corners.txt, columns: {{id: 1, x: 2, y: 3}}}}
"""


def played(folder, recording, system="landmarks", sensors="rangeBearing: {}"):
    """The steps of a log that is told so, its scene, and what was told of it."""
    (folder / "w.yaml").write_text(WORLD.format(system, sensors))
    text = f"world: w.yaml\nrecording:\n  format: log\n  path: log\n{recording}"
    (folder / "c.yaml").write_text(text)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scene = load_scene(folder / "c.yaml")
    return list(play(scene)), scene, [str(one.message) for one in caught]


def seen(x, y, θ):
    """Range and bearing of each corner : (4, 2)"""
    east, north = (MARKS - (x, y)).T
    return np.column_stack([np.hypot(east, north), np.arctan2(north, east) - θ])


def spaced(text):
    return text.replace(",", " ")


def test_turns_and_ways_without_times_go_by_their_order(tmp_path):
    """Turn, way, turn, then what was seen from there; the poses are put together by hand."""
    x, y, θ = 2.0, 1.0, 0.0
    lines = []
    for before, way, after in [(0.1, 0.4, -0.2), (0.3, 0.5, 0.25), (-0.2, 0.3, 0.4)] * 4:
        x, y = x + way * math.cos(θ + before), y + way * math.sin(θ + before)
        θ += before + after
        lines.append(f"ODOMETRY {before} {way} {after}")
        lines += [f"SENSOR {n} {r!r} {b!r}" for n, (r, b) in enumerate(seen(x, y, θ).tolist(), 1)]
    corners = "".join(spaced(f"{line}\n") for line in CORNERS.splitlines()[1:])
    lay(tmp_path / "log", **{"log.txt": "\n".join([*lines, ""]), "corners.txt": corners})
    told_so = TABLES.format(
        motion="rows: ODOMETRY, columns: {turnBefore: 2, distance: 3, turn: 4}",
        readings="rows: SENSOR, columns: {target: 2, range: 3, bearing: 4}",
    )
    steps, scene, told = played(tmp_path, told_so)
    last = steps[-1].posterior.mean
    np.testing.assert_allclose(scene.world.layout.pose(last), [x, y, θ], atol=1e-12)
    assert sum(step.correction is not None for step in steps) == 48
    assert max(step.correction.nis for step in steps if step.correction) < 1e-20
    assert steps[-1].entry.t == 12
    assert any("no column tells the time (t)" in one for one in told)


def test_speeds_without_times_are_refused(tmp_path):
    lay(tmp_path / "log", **{"motion.csv": "v,omega\n1,0\n1,0\n", "readings.csv": "t,x,y\n1,1,1\n"})
    with pytest.raises(UsageError, match="no column is named 't'; found 'v', 'omega'"):
        played(tmp_path, "", sensors="gnss: {}")


def test_rows_of_several_readings_are_read_as_a_row_for_each(tmp_path):
    """The same readings in rows that are not equally long, and one to a row."""
    poses = arc()
    ragged, long = [], ["t,target,range,bearing"]
    for k, (t, x, y, θ) in enumerate(poses.tolist()):
        marks = list(enumerate(seen(x, y, θ).tolist(), 1))[: k % 5]
        groups = "".join(f" {n} {b!r} {r!r}" for n, (r, b) in marks)
        ragged.append(f"{t!r} {x!r} {y!r} {θ!r} {len(marks)}{groups}")
        long += [f"{t!r},{n},{r!r},{b!r}" for n, (r, b) in marks]
    corners = "".join(spaced(f"{line}\n") for line in CORNERS.splitlines()[1:])
    lay(tmp_path / "log", **{"log.txt": "\n".join([*ragged, ""]), "corners.txt": corners})
    told_so = TABLES.format(
        motion="columns: {t: 1, x: 2, y: 3, theta: 4}",
        readings="columns: {t: 1, target: 6, bearing: 7, range: 8}, every: 3",
    )
    ours, scene, told = played(tmp_path, f"{told_so}  truth: {{file: log.txt, "
                               "columns: {t: 1, x: 2, y: 3, theta: 4}}\n")  # fmt: skip
    readings = [step for step in ours if step.correction]
    assert len(readings) == sum(k % 5 for k in range(21))
    assert np.abs(errors(ours, scene.world.layout)).max() < 1e-12
    assert max(step.correction.nis for step in readings) < 1e-20
    assert not told
    other = tmp_path / "other"
    files = {"readings.csv": "\n".join([*long, ""]), "landmarks.csv": CORNERS}
    motion = table("t,x,y,theta", poses.tolist())
    lay(other / "log", **files, **{"motion.csv": motion, "truth.csv": motion})
    theirs, _, _ = played(other, "")
    np.testing.assert_allclose(ours[-1].posterior.covariance, theirs[-1].posterior.covariance)


def test_a_column_for_each_landmark(tmp_path):
    poses = arc()
    rows = [[t, *seen(x, y, θ)[:, 0].tolist()] for t, x, y, θ in poses.tolist()]
    wide = table("t,r_1,r_2,r_3,r_4", rows).replace(repr(rows[3][2]), "")
    motion = table("t,x,y,theta", poses.tolist())
    lay(tmp_path / "log", **{"motion.csv": motion, "wide.csv": wide, "landmarks.csv": CORNERS})
    each = "".join(
        f"    - {{file: wide.csv, target: {n}, columns: {{range: r_{n}}}}}\n" for n in range(1, 5)
    )
    radio = "range: {scale: 1, bias: 0}"
    steps, _, _ = played(tmp_path, f"  readings:\n{each}", sensors=radio)
    corrections = [step.correction for step in steps if step.correction]
    assert len(corrections) == 4 * len(poses) - 1  # one field is empty
    assert max(one.nis for one in corrections) < 1e-20


def test_places_on_the_earth_dates_and_quaternions(tmp_path):
    """The log in latitude and longitude, by another package, is the log in metres."""
    pymap3d = pytest.importorskip("pymap3d")
    poses, begun = arc(n=41), datetime(2011, 9, 26, 13, 2, 25, tzinfo=UTC)
    _, x, y, θ = poses.T
    lat, lon, _ = pymap3d.enu2geodetic(x, y, 0 * x, 49.0, 8.4, 0.0)
    dates = [(begun + timedelta(seconds=t)).strftime("%Y-%m-%d %H:%M:%S.%f") for t in poses[:, 0]]
    earth = [f"{d},{a:.12f},{o:.12f}" for d, a, o in zip(dates, lat, lon, strict=True)]
    turned = [f"{math.sin(h / 2)!r},{math.cos(h / 2)!r}" for h in θ.tolist()]
    truth = [",".join(both) for both in zip(earth, turned, strict=True)]
    d, T = chords(poses).T
    ways = zip(dates, (d / 0.25).tolist(), (T / 0.25).tolist(), strict=False)
    motion = [f"{day},{v!r},{w!r}" for day, v, w in ways]
    lay(
        tmp_path / "log",
        **{"motion.csv": "\n".join(["t,v,omega", *motion, f"{dates[-1]},0,0", ""])},
        **{"readings.csv": "\n".join(["t,lat,lon", *earth[1:], ""])},
        **{"truth.csv": "\n".join(["t,latitude,longitude,qz,qw", *truth, ""])},
    )
    origin = "  origin: {latitude: 49.0, longitude: 8.4}\n"
    steps, scene, told = played(tmp_path, origin, sensors="gnss: {}")
    assert np.abs(errors(steps, scene.world.layout)).max() < 1e-6
    assert max(step.correction.nis for step in steps if step.correction) < 1e-9
    assert steps[0].entry.t == begun.timestamp()
    assert not told
    _, _, told = played(tmp_path, "", sensors="gnss: {}")
    assert "x is m east and y m to true north of its first place, latitude 49.0000" in told[0]
    nowhere = [f"{dates[7]},0,0", f"{dates[9]},,", f"{dates[11]},91,8.4"]
    lay(
        tmp_path / "log",
        **{"readings.csv": "\n".join(["t,lat,lon", *earth[1:6], *nowhere, *earth[12:], ""])},
    )
    steps, _, told = played(tmp_path, origin, sensors="gnss: {}")
    assert sum(step.correction is not None for step in steps) == 34
    assert "3 of 37 rows tell no place on the earth" in told[0]


def test_a_motion_whose_columns_are_named_is_taken(tmp_path):
    poses = arc()
    d, T = chords(poses).T
    ways = np.vstack([np.column_stack([d, T]) / 0.25, [0, 0]])
    rows = np.column_stack([poses[:, 0], 9 * poses[:, 1:], ways]).tolist()
    motion = table("t,x,y,theta,vx,wz", rows)
    files = {"motion.csv": motion, "readings.csv": perfect(poses), "landmarks.csv": CORNERS}
    lay(tmp_path / "log", **files)
    steps, _, told = played(tmp_path, "  motion: {columns: {v: vx, omega: wz}}\n")
    assert max(step.correction.nis for step in steps if step.correction) < 1e-20
    assert not any("the motion is taken from" in one for one in told)


def test_a_file_with_rows_of_several_kinds_is_told_how_to_be_read(tmp_path):
    lay(tmp_path, **{"log": "ODOM 1 2 3\nSEEN 1 2 3\n"})
    with pytest.raises(UsageError) as caught:
        load_scene("log", log=tmp_path / "log")
    assert str(caught.value).removeprefix(str(tmp_path)) == (
        "/log:1:1: 'ODOM 1 2 3' names no columns; rows begin with 'ODOM', 'SEEN': say which are a "
        "table's, and where its columns stand, as in motion: {rows: ODOM, columns: {t: 2, v: 3, "
        "omega: 4}}"
    )


def test_bearings_that_are_unwrapped_are_no_degrees():
    column = Column("bearing", "rad", "", most=BEYOND_A_TURN)
    bearings = np.concatenate([np.linspace(-3, 3, 180), np.linspace(9.5, 13, 15)])
    assert not are_degrees(bearings, column)
    assert are_degrees(np.degrees(bearings), column)


def test_rows_without_names_may_have_decimal_commas_and_turn_rates_degrees(tmp_path):
    poses = arc()
    d, T = chords(poses).T
    ways = np.vstack([np.column_stack([d / 0.25, np.degrees(T / 0.25)]), [0, 0]])
    rows = np.column_stack([poses[:, 0], ways]).tolist()
    for head, key in (("t,v,omega [deg/s]", ""), ("", ", units: {omega: degrees/s}")):
        log = tmp_path / ("named" if head else "bare")
        motion = table(head, rows)
        if not head:
            motion = motion.lstrip("\n").replace(",", ";").replace(".", ",")
        files = {"readings.csv": perfect(poses), "landmarks.csv": CORNERS.replace("id", "name")}
        lay(log / "log", **{"motion.csv": motion}, **files)
        columns = "columns: {t: 1, v: 2, omega: 3}"
        steps, _, _ = played(log, f"  motion: {{{columns}{key}}}\n")
        assert max(step.correction.nis for step in steps if step.correction) < 1e-20


@pytest.mark.parametrize("columns", ["v,omega", "distance,turn", "left,right"])
def test_a_truth_without_headings_looks_ahead_where_the_robot_drives_in_reverse(columns, tmp_path):
    """A circle backwards, whose truth tells positions alone: the heading is half a turn from the
    course, which is that of the chord: half a step's turn, 0.025 rad, beside the robot's own.
    """
    poses = arc(v=-0.5)
    d, T = chords(poses).T
    way = {
        "v,omega": np.vstack([np.column_stack([-d, T]) / 0.25, [-1, 0]]),
        "distance,turn": np.vstack([[0, 0], np.column_stack([-d, T])]),
        "left,right": np.vstack([[0, 0], np.column_stack([-d - T * 0.2, -d + T * 0.2]) / 0.25]),
    }[columns]
    motion = table(f"t,{columns}", np.column_stack([poses[:, 0], way]).tolist())
    truth = table("t,x,y", poses[:, :3].tolist())
    files = {"readings.csv": perfect(poses), "landmarks.csv": CORNERS}
    lay(tmp_path / "log", **{"motion.csv": motion, "truth.csv": truth}, **files)
    width = "  motion: {wheels: speeds, width: 0.4}\n"
    steps, scene, told = played(tmp_path, width if columns == "left,right" else "")
    assert np.abs(errors(steps, scene.world.layout)[:, 2]).max() < 0.06
    assert any("half a turn from it where the robot drives in reverse" in one for one in told)


def test_tables_that_rostopic_writes_need_no_map(tmp_path):
    """`rostopic echo -p`: a comment of names with dots, stamps in ns, quaternions."""
    poses = arc()
    names = [f"position.{one}" for one in "xyz"] + [f"orientation.{one}" for one in "xyzw"]
    rows = []
    for t, x, y, θ in poses.tolist():
        stamp = 1_600_000_000_000_000_000 + round(t * 1e9)
        q = f"0.0,0.0,{math.sin(θ / 2)!r},{math.cos(θ / 2)!r}"
        rows.append(f"{stamp},{stamp},odom,{x!r},{y!r},0.0,{q}")
    files = {}
    for name, part in (("motion.csv", "field.pose.pose."), ("truth.csv", "field.pose.")):
        head = ["%time", "field.header.stamp", "field.header.frame_id", *(part + n for n in names)]
        files[name] = "\n".join([",".join(head), *rows, ""])
    seen_at = perfect(poses + np.array([1.6e9, 0, 0, 0]))
    lay(tmp_path / "log", **files, **{"readings.csv": seen_at, "landmarks.csv": CORNERS})
    steps, scene, _ = played(tmp_path, "")
    assert np.abs(errors(steps, scene.world.layout)).max() < 1e-9
    assert sum(step.correction is not None for step in steps) == 20
    assert max(step.correction.nis for step in steps if step.correction) < 1e-9


def test_a_mistake_in_the_recording_is_told_and_not_what_would_follow_from_it(tmp_path):
    lay(tmp_path / "log", **{"run.csv": "t,v,omega\n0,1,0\n1,1,0\n"})
    keys = "path: log, motion: {file: run.csv}, readings: [{file: run.csv, every: 0}]"
    (tmp_path / "c.yaml").write_text(f"recording: {{format: log, {keys}}}\n")
    with pytest.raises(UsageError, match=r"readings.*every"):
        load_scene(tmp_path / "c.yaml")
