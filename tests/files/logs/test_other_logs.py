"""What the formats pylon, mrclam, ranges and pioneer each have of their own."""

import math

import numpy as np
import pytest
from log_worlds import CLOSET, lay, read, table, world

from ekfsim.errors import InputError, UsageError
from ekfsim.records import Control, Reading
from ekfsim.systems.instruments import Bearings, RangeBearings, Ranges, Ultrasonic


def controls(found):
    return [entry for entry in found.log.entries if isinstance(entry.given, Control)]


def readings(found):
    return [entry for entry in found.log.entries if isinstance(entry.given, Reading)]


def told(found):
    """The warnings, without the folder, and without where the filter begins."""
    lines = [line for line in found.warnings if "no truth tells where it starts" not in line]
    return [line.rpartition("log")[2] if "/log" in line else line for line in lines]


# pylon
# ------------------------------------------------------------------------------------------

START = 1_582_766_482 << 32


def pylon(folder, *rows, ending=",\n"):
    """Rows of X, Y, stamp, yaw."""
    text = "".join(
        f"{x},{y},-0.3,{stamp},34.1,-117.7,{yaw},0,0,0.5,0.25,0{ending}"
        for x, y, stamp, yaw in rows
    )
    return lay(folder, **{"walk.csv": text})


def test_a_pylon_log_with_and_without_its_trailing_comma(tmp_path):
    rows = [(0, 5 + k, START + 100_000 * k, 0) for k in range(4)]
    a, b = (
        read("pylon", pylon(tmp_path / name, *rows, ending=end))
        for name, end in (("a", ",\n"), ("b", "\n"))
    )
    for found in (a, b):
        assert told(found) == []
        assert [entry.t for entry in controls(found)] == pytest.approx([0.1, 0.2, 0.3, 0.4])
        np.testing.assert_allclose(controls(found)[2].given.u, [0.5, 0.25, 0, 0.1])
        np.testing.assert_allclose(
            [entry.given.z for entry in readings(found)], [[5 + k, 0] for k in range(4)]
        )


@pytest.mark.parametrize(
    ("yaw", "θ"),
    [(90, -math.pi / 2), (180, math.pi), (-180, math.pi), (540, math.pi), (270, math.pi / 2)],
)
def test_the_yaw_of_a_pylon_log_grows_clockwise(tmp_path, yaw, θ):
    found = read("pylon", pylon(tmp_path / "log", (3, 4, START, yaw)))
    assert controls(found)[0].given.u[2] == θ
    east, north = readings(found)[0].given.z  # x to the right of the robot, y ahead
    ahead, right = (math.cos(θ), math.sin(θ)), (math.sin(θ), -math.cos(θ))
    assert (east, north) == pytest.approx(
        (4 * ahead[0] + 3 * right[0], 4 * ahead[1] + 3 * right[1])
    )


def test_the_clock_of_a_pylon_log_runs_over(tmp_path):
    low = (1 << 32) - 150_000
    stamps = [
        START + low,
        START + low + 100_000,
        START + (1 << 32) * 3 + 50_000,
        f"{float(START + 163_840):.17g}",
    ]
    found = read("pylon", pylon(tmp_path / "log", *((1, 2, stamp, 0) for stamp in stamps)))
    assert [entry.given.u[3] for entry in controls(found)] == pytest.approx(
        [0.1, 0.1, 0.1, 0.11384]
    )
    coded = read("pylon", tmp_path / "log", reading="coded")
    assert [entry.given.u[3] for entry in controls(coded)] == [0.1] * 4
    assert [entry.t for entry in controls(coded)] == [entry.t for entry in controls(found)]


def test_rows_of_a_pylon_log_out_of_order_or_without_a_pylon(tmp_path):
    rows = [(0, 5 + k, START + 100_000 * k, 0) for k in (0, 2, 1, 3)]
    rows[3] = ("nan", "nan", START + 300_000, 0)
    rows.append((0, 0, START + 400_000, 0))  # no return, as many a lidar tells it
    found = read("pylon", pylon(tmp_path / "log", *rows))
    np.testing.assert_allclose([entry.given.z[0] for entry in readings(found)], [5, 6, 7])
    assert len(controls(found)) == 5
    assert told(found) == [
        "/walk.csv:3: Time Stamp lies 0.1 s before the row above: the rows are put in order of "
        "time",
        "/walk.csv: in 2 of 5 rows the lidar did not see the pylon",
    ]


@pytest.mark.parametrize("stamp", ["nan", "-5", "1e30"])
def test_a_stamp_that_is_none_is_refused(tmp_path, stamp):
    with pytest.raises(InputError) as refused:
        read("pylon", pylon(tmp_path / "log", (1, 2, START, 0), (1, 2, stamp, 0), (1, 2, START, 0)))
    assert f"walk.csv:2:10: Time Stamp: '{stamp}' is no stamp; it is a 64-bit number" in str(
        refused.value
    )


def test_a_pylon_folder_holds_one_csv(tmp_path):
    folder = pylon(tmp_path / "log", (1, 2, START, 0))
    (folder / "other.csv").write_text("")
    with pytest.raises(UsageError, match=r"several files '\*\.csv' in it: other\.csv, walk\.csv"):
        read("pylon", folder)
    assert len(read("pylon", folder / "walk.csv").log.entries) == 3
    with pytest.raises(UsageError, match="no such file; name the CSV file of the lidar"):
        read("pylon", folder / "walk.txt")
    with pytest.raises(UsageError, match="the sensor pylon or lidar sees, not 0"):
        read("pylon", folder / "walk.csv", world("pylon"))
    with pytest.raises(
        InputError, match=r"walk.csv:1:1: 3 columns stand in this row; it must have 12"
    ):
        read("pylon", lay(tmp_path / "short", **{"walk.csv": "1,2,3\n" * 3}))


# mrclam
# ------------------------------------------------------------------------------------------

MRCLAM = {
    "Robot3_Odometry.dat": "# t v ω\n100.00 1.0 0.0\n100.10\t0.5 0.2\n100.20 0.0 0.0\n",
    "Robot3_Measurement.dat": "100.05 63 2 0.1\n100.05 5 1 0\n100.10 63 2.1 0.2\n100.15 99 1 "
    "0\n100.20 63 2 0\n",
    "Robot3_Groundtruth.dat": "99.9 0.0 0.0 0.0\n100.3 0.4 0.0 0.4\n",
    "Barcodes.dat": "1 5\n3 14\n7 63\n",
    "Landmark_Groundtruth.dat": "7 2.0 0.5 0.001 0.001\n",
}


def test_a_row_of_mrclam_holds_until_the_next(tmp_path):
    found = read("mrclam", lay(tmp_path / "log", **MRCLAM))
    log = found.log.entries
    assert [(e.t, type(e.given).__name__, e.judged) for e in log] == [
        *(
            (100.0, "NoneType", True),
            (100.05, "Control", False),
            (100.05, "Reading", False),
            (100.1, "Control", True),
        ),
        *((100.1, "Reading", True), (100.2, "Control", True), (100.2, "Reading", True)),
    ]
    np.testing.assert_allclose(
        [e.given.u for e in controls(found)], [[1, 0, 0.05], [1, 0, 0.05], [0.5, 0.2, 0.1]]
    )
    np.testing.assert_allclose([e.given.z for e in readings(found)], [[2, 0.1], [2.1, 0.2], [2, 0]])
    assert {e.given.name for e in readings(found)} == {"landmark 7"}
    np.testing.assert_allclose(found.log.first.mean, [0.1, 0, 0.1])
    np.testing.assert_allclose(found.log.first.covariance, np.eye(3) * 1e-4)
    assert told(found) == [
        "/Robot3_Measurement.dat:2: this measurement is of another robot: left out",
        "/Robot3_Measurement.dat:4: this measurement is of no known barcode: left out",
    ]


def test_what_the_worlds_instrument_sees_of_mrclam(tmp_path):
    folder = lay(tmp_path / "log", **MRCLAM)
    for instrument, z in (
        (RangeBearings(), [2, 0.1]),
        (Bearings(), [0.1]),
        (Ranges(scale=1.25, bias=0.5), [1.2]),
    ):
        found = read("mrclam", folder, world("mrclam", instruments=(instrument,)))
        np.testing.assert_allclose(readings(found)[0].given.z, z)
    with pytest.raises(
        UsageError, match="belongs to a world with the sensor rangeBearing or bearing or range"
    ):
        read("mrclam", folder, world("mrclam", instruments=(Ultrasonic(),)))


@pytest.mark.parametrize(
    ("file", "text", "wrong"),
    [
        ("Barcodes.dat", "1 5\n3 14\n7 63\n8 63\n",
         "Barcodes.dat:4:1: the subject 7 has the barcode 63 already"),
        ("Barcodes.dat", "1 5\n3 14.5\n7 63\n",
         "Barcodes.dat:2:1: 3 or 14.5 is no name; both are whole numbers"),
        ("Landmark_Groundtruth.dat", "7 1 1 0 0\n7 2 2 0 0\n",
         "dat:2:1: the landmark 7 stands here again; name"),
        ("Landmark_Groundtruth.dat", "7.5 1 1 0 0\n",
         "dat:1:1: 7.5 names no landmark; an id is a whole number"),
        ("Robot3_Odometry.dat", "1 0 0 0\n", "Odometry.dat:1:1: 4 columns stand in this row; it "
                                             "must have 3"),
        ("Robot3_Odometry.dat", "1;0;0\n", "log: the motion has one instant alone"),
        ("Landmark_Groundtruth.dat", "7 1\n", "dat:1:1: 2 columns stand in this row; it must have "
                                              "3 or more"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_mrclam(tmp_path, file, text, wrong):
    with pytest.raises(UsageError) as refused:
        read("mrclam", lay(tmp_path / "log", **{**MRCLAM, file: text}))
    assert wrong in str(refused.value)


@pytest.mark.parametrize("number", ["0", "-1.5"])
def test_a_range_of_nothing_is_left_out_and_told(tmp_path, number):
    sound = MRCLAM["Robot3_Measurement.dat"]
    odd = sound.replace("100.20 63 2 0\n", f"100.15 63 {number} 0\n100.20 63 2 0\n")
    found = read("mrclam", lay(tmp_path / "log", **{**MRCLAM, "Robot3_Measurement.dat": odd}))
    np.testing.assert_allclose([e.given.z[0] for e in readings(found)], [2, 2.1, 2])
    assert (
        told(found)[0]
        == f"/Robot3_Measurement.dat:5: range: {number} is no range: this row is left out"
    )
    near = read(
        "ranges", plaza(tmp_path / "plaza", ranges=((0.05, 4, 2.242), (0.3, 5, float(number))))
    )
    assert len(readings(near)) == 1
    assert near.warnings == [
        f"{tmp_path}/plaza/ranges.csv:3: range: {number} is no range: this row is left out"
    ]


# ranges
# ------------------------------------------------------------------------------------------


def plaza(folder, backwards=0.0, ranges=((0.05, 4, 2.242), (0.3, 5, 3.308))):
    strides = [[0.1 * k, 1.0, 0.1] for k in range(1, 6)]
    truth = [
        [0.1 * k, math.sin(0.1 * k) * 10, 10 - 10 * math.cos(0.1 * k), 0.1 * k + backwards]
        for k in range(6)
    ]
    files = {
        "odometry.csv": table("t,distance,dheading", strides),
        "ranges.csv": table("t,antenna,node,range", [[t, 2, node, r] for t, node, r in ranges]),
        "nodes.csv": "node,x,y\n4,1.0,2.0\n5,3.0,4.0\n",
        "groundtruth.csv": table("t,x,y,heading", truth),
    }
    return lay(folder, **files)


def test_a_stride_is_split_where_a_range_falls_into_it(tmp_path):
    found = read("ranges", plaza(tmp_path / "log"))
    np.testing.assert_allclose(
        [e.given.u for e in controls(found)][:3], [[0.5, 0.05, 0.05]] * 2 + [[1, 0.1, 0.1]]
    )
    assert [e.judged for e in found.log.entries] == [True, False, False] + [True] * 6
    # (r − 0.11)/1.066
    np.testing.assert_allclose([e.given.z for e in readings(found)], [[2.0], [3.0]])
    assert [e.given.name for e in readings(found)] == ["node 4", "node 5"]
    assert found.log.entries[0].t == 0.0
    assert found.warnings == []
    place = world("ranges", instruments=(Ranges(scale=1.0, bias=0.0),))
    assert readings(read("ranges", tmp_path / "log", place))[0].given.z[0] == 2.242


@pytest.mark.parametrize("backwards", [0.0, math.pi, -math.pi])
def test_the_true_heading_points_where_the_robot_goes(tmp_path, backwards):
    found = read("ranges", plaza(tmp_path / "log", backwards))
    for entry in found.log.entries:
        assert entry.truth[2] == pytest.approx(entry.t, abs=1e-9)
    against = (
        "the true headings point against the first metres of travel as the odometry counts them"
    )
    assert told(found) == [
        f": {against}: half a turn is added (otherwise: --set recording.turnTruth=never)"
    ] * bool(backwards)


@pytest.mark.parametrize("backwards", [0.0, math.pi])
def test_a_robot_that_starts_in_reverse_heads_away_from_where_it_goes(tmp_path, backwards):
    way, truth, x = [-0.5] * 8 + [0.5] * 12, [], 0.0
    for k, d in enumerate([0.0, *way]):
        x += d
        truth.append([0.1 * k, x, 0.0, 0.0 + backwards])
    folder = plaza(tmp_path / "log")
    lay(folder, **{
        "odometry.csv": table("t,distance,dheading", [[0.1 * k, d, 0.0] for k, d in enumerate(way,
        1)]),
        "groundtruth.csv": table("t,x,y,heading", truth),
    })  # fmt: skip
    found = read("ranges", folder)
    assert {round(float(e.truth[2]), 9) for e in found.log.entries} == {0.0}
    assert ("half a turn is added" in " ".join(found.warnings)) == bool(backwards)


def test_ranges_are_sorted_and_unknown_nodes_told(tmp_path):
    found = read(
        "ranges",
        plaza(
            tmp_path / "log",
            ranges=((0.3, 5, 3.308), (0.05, 4, 2.242), (0.2, 9, 1), (0.25, 4.5, 1)),
        ),
    )
    np.testing.assert_allclose([e.given.z for e in readings(found)], [[2.0], [3.0]])
    assert told(found) == [
        "/ranges.csv:3: the time 0.05 lies before that of the row above: the rows are put in "
        "order of time",
        "/ranges.csv:4: nodes.csv has no node 9, nor those of 1 more rows: left out",
    ]


def test_strides_without_truth_begin_a_usual_step_before(tmp_path):
    folder = plaza(tmp_path / "log")
    (folder / "groundtruth.csv").unlink()
    found = read("ranges", folder, world("ranges", start=(1.0, 2.0, 0.0)))
    assert found.log.entries[0].t == pytest.approx(0.0)
    np.testing.assert_array_equal(found.log.first.mean, [1, 2, 0])


# pioneer
# ------------------------------------------------------------------------------------------


def pioneer(folder, **more):
    files = {
        "odometry.csv": "t,left,right\n0,0,0\n0.1,0.02,0.02\n0.2,0.03,0.02\n",
        "ultrasonic.csv": "t,beam,range\n0.1,4,1.5\n0.2,9,1.0\n0.2,4.5,1.0\n",
        "infrared.csv": "t,pair,intensity\n0.1,2,0.7\n",
        **more,
    }
    return lay(folder, **{name: text for name, text in files.items() if text is not None})


def test_the_beams_of_a_pioneer(tmp_path):
    found = read("pioneer", pioneer(tmp_path / "log"), world("pioneer", floor=CLOSET))
    assert [(e.given.name, *e.given.z) for e in readings(found)] == [
        ("ultrasonic 4", 1.5),
        ("infrared 2", 0.7),
    ]
    np.testing.assert_array_equal(
        [e.given.u for e in controls(found)], [[0.02, 0.02], [0.03, 0.02]]
    )
    assert told(found) == [
        ": no groundtruth*.csv in it: the truth is unknown, and so are the errors",
        "/ultrasonic.csv:3: the world's ultrasonic sensor has no number 9, nor those of 1 more "
        "rows: left out",
    ]


def test_a_pioneer_with_one_kind_of_beam_or_none(tmp_path):
    folder = pioneer(tmp_path / "log", **{"infrared.csv": None})
    found = read("pioneer", folder, world("pioneer", floor=CLOSET))
    assert ": no infrared.csv in it: there are no such readings" in told(found)
    (folder / "ultrasonic.csv").unlink()
    with pytest.raises(
        UsageError, match=r"neither ultrasonic.csv nor infrared.csv in it for a sensor of 'test'"
    ):
        read("pioneer", folder, world("pioneer", floor=CLOSET))


def test_the_first_row_of_a_pioneer_is_the_start(tmp_path):
    text = "t,left,right\n0,1,1\n0.1,0.02,0.02\n"
    found = read(
        "pioneer",
        pioneer(tmp_path / "log", **{"odometry.csv": text}),
        world("pioneer", floor=CLOSET),
    )
    assert len(controls(found)) == 1
    assert "/odometry.csv:2: the first row is the start: its ways count for nothing" in told(found)


# all
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("format", ["gnss", "mower", "mrclam", "ranges", "pioneer"])
def test_an_empty_folder_is_no_log(tmp_path, format):
    with pytest.raises(UsageError, match="in it; it would hold the "):
        read(format, tmp_path)
