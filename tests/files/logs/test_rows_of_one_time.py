"""Rows of the odometry that share a time: what was driven is neither lost nor driven twice."""

import math
from dataclasses import replace

import numpy as np
import pytest
from log_worlds import SHARED, lay, read, rmse, shared, steps_of, table, world

from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log
from ekfsim.files.logs.ordering import apart
from ekfsim.files.logs.table import Rows
from ekfsim.localization import play
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene

OTHERWISE = "(otherwise: --set recording.sameTime=share, add, first or last)"


def rows(*values):
    return Rows("odo", np.arange(1, len(values) + 1), np.array(values, dtype=float))


def spread(*values, asked=None, until_next=False):
    warnings = list[str]()
    return apart(rows(*values), warnings, asked, until_next).values.tolist(), warnings


def test_rows_of_one_time_share_the_span_until_the_next():
    times = 0.0, 0.0, 1.0, 2.2, 2.2
    told = [(t, k, 1 + k) for k, t in enumerate(times)]
    found, warnings = spread(*told, (3.4, 1, 1), until_next=True)
    np.testing.assert_allclose([t for t, _, _ in found], [0, 0.5, 1, 2.2, 2.8, 3.4])
    assert [u for _, *u in found] == [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [1, 1]]
    assert warnings == [
        "odo:2: the time 0 is that of the row above, too, and so do 1 more: rows of one time share "
        f"the span until the next evenly {OTHERWISE}"
    ]


def test_or_the_span_since_the_one_before_where_a_row_tells_what_was():
    found, warnings = spread((0, 1, 2), (1, 3, 4), (1, 5, 6), (2, 7, 8))
    assert found == [[0, 1, 2], [0.5, 3, 4], [1, 5, 6], [2, 7, 8]]
    assert "share the span since the one before evenly" in warnings[0]


def test_a_clock_that_counts_whole_seconds_tells_when_each_began():
    cut = [(k // 3, k, 1) for k in range(9)]
    found, warnings = spread(*cut)
    np.testing.assert_allclose([t for t, _, _ in found], np.arange(9) / 3)
    assert (
        "the times seem cut to 1 s, and rows of one time share the span until the next evenly"
        in (warnings[0])
    )


def test_over_a_gap_rows_share_no_more_than_a_usual_span():
    found, _ = spread(
        (0, 1, 1), (1.01, 2, 2), (1.01, 3, 3), (100, 4, 4), (101, 1, 1), until_next=True
    )
    assert [round(t, 3) for t, _, _ in found] == [0, 1.01, 1.515, 100, 101]


def test_parts_of_one_row_are_added_up():
    apart_by_kind = [(t, *u) for t in (0, 0.1, 0.23) for u in ((0.5, 0), (0, 0.2))]
    found, warnings = spread(*apart_by_kind, until_next=True)
    assert found == [[t, 0.5, 0.2] for t in (0, 0.1, 0.23)]
    assert "rows of one time are added up, for one says 0 where the other does not" in warnings[0]
    stops = [(t, *u) for t in (0, 0.1, 0.23) for u in ((0.5, 0.2), (0, 0))]
    assert spread(*stops, until_next=True)[0] == found


def test_repeated_rows_say_nothing_new():
    found, warnings = spread((0, 1, 2), (1, 3, 4), (1, 3, 4), (2, 5, 6), until_next=True)
    assert found == [[0, 1, 2], [1, 3, 4], [2, 5, 6]]
    assert warnings == ["odo:3: this row repeats another of the same time: left out"]


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        ("share", [[0, 1, 0], [0.5, 0, 1], [1, 5, 6]]),
        ("add", [[0, 1, 1], [1, 5, 6]]),
        ("first", [[0, 1, 0], [1, 5, 6]]),
        ("last", [[0, 0, 1], [1, 5, 6]]),
    ],
)
def test_what_they_mean_can_be_said(asked, expected):
    found, warnings = spread((0, 1, 0), (0, 0, 1), (1, 5, 6), asked=asked, until_next=True)
    assert found == expected
    assert len(warnings) == 1
    assert "otherwise" not in warnings[0]


def driven(format, folder, **keys):
    """The way and the turn of all motion inputs of a log, in its own odometry."""
    recording = RecordingKeys(format=format, **keys)
    log = read_log(recording, folder, world(format), "corrected", []).log
    us = [e.given.u for e in log.entries if isinstance(e.given, Control)]
    return np.sum([[u[0] * u[2], u[1] * u[2]] if format == "mrclam" else u[:2] for u in us], axis=0)


def test_strides_of_one_time_are_all_made(tmp_path):
    strides = [[0.1, 1.0, 0.1], [0.2, 0.5, 0.0], [0.2, 0.25, 0.2], [0.3, 1.0, 0.1]]
    folder = lay(
        tmp_path / "log",
        **{
            "odometry.csv": table("t,distance,dheading", strides),
            "ranges.csv": "t,node,range\n0.25,4,2.0\n",
            "nodes.csv": "node,x,y\n4,1.0,2.0\n",
        },
    )
    np.testing.assert_allclose(driven("ranges", folder), [2.75, 0.4])


@pytest.mark.parametrize("same_time", [None, "share", "add"])
def test_a_log_of_ones_own_loses_no_way(tmp_path, same_time):
    folder = lay(
        tmp_path / "log",
        **{
            "motion.csv": "t,distance,turn\n0,0,0\n1,2,0.1\n1,0,0.3\n2.2,1,0\n2.2,1.5,0\n",
            "readings.csv": "t,target,range,bearing\n1.5,4,2,0\n",
            "landmarks.csv": "id,x,y\n4,1,2\n",
        },
    )
    keys = {} if same_time is None else {"sameTime": same_time}
    found = read_log(
        RecordingKeys(format="log", **keys), folder, world("ranges"), "corrected", []
    ).log
    us = [e.given.u for e in found.entries if isinstance(e.given, Control)]
    np.testing.assert_allclose(np.sum(us, axis=0)[:2], [4.5, 0.4])


def test_a_log_of_one_instant_goes_nowhere(tmp_path):
    odometry = "100 1 0\n100 2 0\n100 1 1\n"
    files = {
        "Odometry.dat": odometry,
        "Measurement.dat": "100 63 1 0\n",
        "Barcodes.dat": "7 63\n",
        "Landmark_Groundtruth.dat": "7 1 0 0 0\n",
    }
    np.testing.assert_allclose(driven("mrclam", lay(tmp_path / "log", **files)), [0, 0])


# the logs at hand, their stamps made worse on purpose: what is right was known before


def changed(tmp_path, source, file, change):
    """A copy of a log in which one file has other rows."""
    texts = {path.name: path.read_text() for path in source.iterdir()}
    head, *body = [line for line in texts[file].splitlines() if not line.startswith("#")]
    named = head[:1].isalpha()
    separator = "," if named else "\t"
    split = [line.replace(",", " ").split() for line in (body if named else [head, *body])]
    made = [separator.join(row) for row in change(split)]
    return lay(tmp_path / "log", **{**texts, file: "\n".join([*[head] * named, *made, ""])})


def whole_seconds(table):
    return [[str(math.floor(float(t))), *rest] for t, *rest in table]


def in_threes(table):
    """As a buffer writes them: three rows at the time of the last."""
    return [[table[min(k // 3 * 3 + 2, len(table) - 1)][0], *rest] for k, (_, *rest) in
            enumerate(table)]  # fmt: skip


@pytest.mark.parametrize("change", [whole_seconds, in_threes])
@pytest.mark.parametrize(
    ("format", "name", "file", "reach"),
    [
        ("ranges", "plaza2_mower_ranges", "odometry.csv", 0.45),
        ("gnss", "mower_gnss", "wheelspeeds-1.csv", 0.087),
    ],
)
def test_coarse_stamps_of_the_odometry_keep_the_reach(tmp_path, change, format, name, file, reach):
    folder = changed(tmp_path, shared(name), file, change)
    steps, scene, _ = steps_of(format, folder, gate=0.999)
    assert rmse(steps, scene) < reach


def motion_alone(folder):
    log = read("mrclam", folder).log
    entries = tuple(e for e in log.entries if not isinstance(e.given, Reading))
    scene = Scene(world("mrclam"), log=replace(log, entries=entries))
    return rmse(list(play(scene)), scene)


def minute(tmp_path, change):
    """The first minute of a robot, one row of the odometry a time; and as it is changed."""
    source = SHARED.parent / "cases" / "logs" / "dupdiff"
    if not source.exists():
        pytest.skip("the log with rows of one time is not here")
    return changed(tmp_path, source, "Robot1_Odometry.dat", lambda table: change(table[::2]))


def test_a_row_of_standstill_beside_each_stops_nothing(tmp_path):
    as_is = minute(tmp_path, lambda table: table)
    expected = motion_alone(as_is)
    assert expected == pytest.approx(0.1324, abs=1e-4)
    twice = minute(
        tmp_path, lambda table: [row for t, *u in table for row in ([t, *u], [t, "0", "0"])]
    )
    assert motion_alone(twice) == pytest.approx(expected, abs=1e-9)


def test_a_minute_in_whole_seconds(tmp_path):
    """0.655 m where one row of each second holds."""
    assert motion_alone(minute(tmp_path, whole_seconds)) < 0.132
