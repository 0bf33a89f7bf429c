"""What is odd in a log: handled as a person would want and told, or refused with its place."""

import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from log_worlds import MARKS, lay, read, table, world

from ekfsim.errors import InputError, UsageError
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.settings import setting
from ekfsim.records import Control, Reading

WHEELS = [[k / 10, 1.0, 0.5] for k in range(11)]  # t, vr, vl
FIXES = [[k / 5 + 0.05, 0.1 * k, 0.2] for k in range(4)]
WANTED = "; wanted are t in s, vr in m/s, vl in m/s (ekfsim schema recording)"
TRUTH = [[k / 10, 0.075 * k, 0.0, 0.05 * k] for k in range(11)]


def gnss(folder, wheels=None, fixes=None, truth=None):
    files = {
        "wheelspeeds-1.csv": table("time,vr,vl", WHEELS) if wheels is None else wheels,
        "gnss-1.csv": table("t,x,y", FIXES) if fixes is None else fixes,
        "groundtruth-1.csv": table("t,x,y,phi", TRUTH) if truth is None else truth,
    }
    for name, text in files.items():
        if text == "absent":
            (folder / name).unlink()
    return lay(folder, **{name: text for name, text in files.items() if text != "absent"})


@pytest.fixture
def log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def made(**files):
        return gnss(tmp_path / "log", **files)

    made()
    return made


def given(found, kind):
    return [entry for entry in found.log.entries if isinstance(entry.given, kind)]


def where_it_begins(found):
    return [told for told in found.warnings if told.startswith("log: no truth tells where")]


LOG = Path("log")


def same(found, other):
    """Whether two logs hold the same."""
    assert len(found.log.entries) == len(other.log.entries)
    for a, b in zip(found.log.entries, other.log.entries, strict=True):
        assert (a.index, a.t, a.judged, type(a.given)) == (b.index, b.t, b.judged, type(b.given))
        np.testing.assert_array_equal(a.truth, b.truth)
        for name in ("u", "z"):
            np.testing.assert_array_equal(getattr(a.given, name, 0), getattr(b.given, name, 0))
    return True


def test_a_sound_log_is_read_without_a_word(log):
    found = read("gnss", LOG)
    assert found.warnings == []
    assert found.landmarks is None
    assert [entry.index for entry in found.log.entries] == list(range(len(found.log.entries)))
    assert found.log.entries[0].t == 0.0
    assert given(found, Reading)[0].given.name == "gnss"
    np.testing.assert_array_equal(
        [entry.given.z for entry in given(found, Reading)], np.array(FIXES)[:, 1:]
    )
    np.testing.assert_array_equal(found.log.first.mean, np.zeros(4))
    np.testing.assert_allclose(found.log.first.covariance, np.diag([1, 0.05, 0.05, 0.05]) ** 2)


def test_a_reading_between_two_rows_cuts_the_motion_in_two(log):
    inputs = given(read("gnss", LOG), Control)
    assert sum(float(entry.given.u[2]) for entry in inputs) == pytest.approx(1.0)
    before, after = inputs[:2]
    assert (before.t, after.t) == (0.05, 0.1)
    np.testing.assert_allclose([before.given.u, after.given.u], [[0.5, 1.0, 0.05]] * 2)
    np.testing.assert_allclose(before.truth, [0.0375, 0.0, 0.025])


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: "\ufeff" + text,
        lambda text: text.replace(",", "\t"),
        lambda text: text.replace(",", " , "),
        lambda text: text.replace(",", ";"),
        lambda text: text.replace("\n", ",\n"),
        lambda text: text.replace("\n", "\n\n"),
        lambda text: "# wheel speeds\n" + text + "# the end\n",
        lambda text: text.upper(),
    ],
    ids=[
        "CRLF",
        "CR",
        "BOM",
        "tabs",
        "spaces",
        "semicolons",
        "trailing commas",
        "blank lines",
        "comments",
        "capitals",
    ],
)
def test_ways_to_write_a_table(log, change):
    sound = read("gnss", LOG)
    texts = {name: table(header, rows) for name, header, rows in (
        ("wheels", "time,vr,vl", WHEELS), ("fixes", "t,x,y", FIXES), ("truth", "t,x,y,phi",
        TRUTH))}  # fmt: skip
    log(**{name: change(text) for name, text in texts.items()})
    found = read("gnss", LOG)
    assert same(found, sound)
    assert found.warnings == []


def test_columns_stand_in_any_order_and_others_are_not_read(log):
    sound = read("gnss", LOG)
    rows = [[left, "ok", t, right] for t, right, left in WHEELS]
    log(wheels="\n".join(["vl,status,t,vr", *(",".join(map(str, row)) for row in rows), ""]))
    assert same(read("gnss", LOG), sound)


def test_rows_out_of_order_are_put_in_order_and_told(log):
    sound = read("gnss", LOG)
    wheels, fixes, truth = WHEELS.copy(), FIXES[::-1], TRUTH.copy()
    wheels[3], wheels[7] = wheels[7], wheels[3]
    truth.append(truth.pop(4))
    log(
        wheels=table("time,vr,vl", wheels),
        fixes=table("t,x,y", fixes),
        truth=table("t,x,y,phi", truth),
    )
    found = read("gnss", LOG)
    assert same(found, sound)
    assert found.warnings == [
        "log/wheelspeeds-1.csv:6: the time 0.4 lies before that of the row above, and so do 1 "
        "more: "
        "the rows are put in order of time",
        "log/groundtruth-1.csv:12: the time 0.4 lies before that of the row above: the rows are "
        "put in order of time",
        "log/gnss-1.csv:3: the time 0.45 lies before that of the row above, and so do 2 more: "
        "the rows are put in order of time",
    ]


def test_a_row_that_stands_twice_is_left_out_and_told(log):
    sound = read("gnss", LOG)
    wheels, fixes, truth = ([*rows[:3], rows[2], *rows[3:]] for rows in (WHEELS, FIXES, TRUTH))
    log(
        wheels=table("time,vr,vl", wheels),
        fixes=table("t,x,y", fixes),
        truth=table("t,x,y,phi", truth),
    )
    found = read("gnss", LOG)
    assert same(found, sound)
    assert [told.partition(": ")[::2] for told in found.warnings] == [
        (f"log/{name}-1.csv:5", "this row repeats another of the same time: left out")
        for name in ("wheelspeeds", "groundtruth", "gnss")
    ]


def test_two_rows_of_one_time_that_differ(log):
    sound = read("gnss", LOG)
    truth = [*TRUTH[:3], [0.2, 9.0, 9.0, 0.0], *TRUTH[3:]]
    log(truth=table("t,x,y,phi", truth))
    found = read("gnss", LOG)
    assert same(found, sound)
    assert found.warnings == ["log/groundtruth-1.csv:5: a second pose of the same time: left out"]
    fixes = [*FIXES, [FIXES[-1][0], 0.7, 0.7]]
    log(
        fixes=table("t,x,y", fixes),
        wheels=table("time,vr,vl", WHEELS),
        truth=table("t,x,y,phi", TRUTH),
    )
    np.testing.assert_array_equal(
        [e.given.z for e in given(read("gnss", LOG), Reading)], np.array(fixes)[:, 1:]
    )


def test_a_gap_is_told_with_its_place_and_length(log):
    wheels = [[t + 2.0 if t > 0.45 else t, right, left] for t, right, left in WHEELS]
    log(wheels=table("time,vr,vl", wheels), truth="absent")
    found = read("gnss", LOG)
    assert found.warnings == [
        "log: no groundtruth*.csv in it: the truth is unknown, and so are the errors",
        "log/wheelspeeds-1.csv:7: a gap of 2.1 s before this row; the usual step is 0.1 s",
        *where_it_begins(found),
    ]
    assert given(found, Control)[-1].truth is None


def test_over_a_gap_of_the_truth_it_is_not_known(log):
    truth = [
        row for row in [*TRUTH, *([k / 10, 1.0, 1.0, 0.0] for k in range(30, 41))] if row[0] != 0.5
    ]
    wheels = [[k / 10, 1.0, 0.5] for k in range(45)]
    log(wheels=table("time,vr,vl", wheels), truth=table("t,x,y,phi", truth))
    known = {round(entry.t, 9): entry.truth is not None for entry in read("gnss", LOG).log.entries}
    assert all(known[k / 10] for k in range(11))  # 0.5 too: interpolated over a short one
    assert not any(known[k / 10] for k in [*range(11, 30), *range(41, 45)])
    assert all(known[k / 10] for k in range(30, 41))


@pytest.mark.parametrize(
    ("number", "what"),
    [
        ("nan", "nan is no number"),
        ("inf", "inf is no number"),
        ("-Infinity", "-inf is no number"),
        ("1e999", "inf is no number"),
        ("2.96439e-322", "2.96439e-322 is a denormal"),
        ("1e7", "1e+07 is absurdly large"),
        ("-3e200", "-3e+200 is absurdly large"),
    ],
)
def test_a_row_with_a_number_that_cannot_be_meant_is_left_out(log, number, what):
    log(wheels=table("time,vr,vl", WHEELS).replace("0.5,1.0,0.5", f"0.5,1.0,{number}"))
    found = read("gnss", LOG)
    assert found.warnings == [f"log/wheelspeeds-1.csv:7: vl: {what}: this row is left out"]
    assert sum(float(entry.given.u[2]) for entry in given(found, Control)) == pytest.approx(1.0)


def test_places_in_metres_of_a_map_projection_can_be_meant(log):
    far = [[t, x + 4.2e5, y + 5.3e6] for t, x, y in FIXES]
    log(fixes=table("t,x,y", far))
    assert read("gnss", LOG).warnings == []


def test_many_such_rows_are_counted(log):
    fixes = [[t, math.nan, y] for t, x, y in FIXES * 3]
    log(fixes=table("t,x,y", [*fixes, *FIXES]))
    found = read("gnss", LOG)
    assert len(given(found, Reading)) == 4
    assert found.warnings[:4] == [
        *(
            f"log/gnss-1.csv:{line}: x: nan is no number: this row is left out"
            for line in (2, 3, 4)
        ),
        "log/gnss-1.csv:5: so are 9 more rows from here on",
    ]


def test_stamps_that_no_unit_makes_a_time_are_told_though_nothing_is_left_to_localize(log):
    log(wheels=table("time,vr,vl", [[(1.248e9 + t) * -1e15, *more] for t, *more in WHEELS]))
    warnings = []
    with pytest.raises(InputError) as refused:
        read_log(RecordingKeys(format="gnss"), LOG, world("gnss"), "corrected", warnings)
    told = "t: -1.248e+24 is no time in s"
    assert warnings == [
        *(f"log/wheelspeeds-1.csv:{line}: {told}: this row is left out" for line in (2, 3, 4)),
        "log/wheelspeeds-1.csv:5: so are 8 more rows from here on",
    ]
    nothing = "without wheel speeds there is nothing to localize"
    assert (
        str(refused.value)
        == f"log/wheelspeeds-1.csv:1:1: all 11 rows are left out: {told}; {nothing}"
    )


def test_what_is_odd_in_a_log_is_told_before_why_it_is_refused(log):
    fixes = [*FIXES, [math.nan, 0.0, 0.0]]
    log(
        fixes=table("t,x,y", fixes),
        truth=table("t,x,y,phi", [[t + 100, *pose] for t, *pose in TRUTH]),
    )
    for settings in ((), (setting("start.x=1"),)):
        found = read_scene(resolve("gnss_log", "commands"), None, LOG, settings=settings)
        assert found.warnings == ["log/gnss-1.csv:6: t: nan is no number: this row is left out"]
        with pytest.raises(UsageError, match="the truth and the motion have no instant in common"):
            found.get()


@pytest.mark.parametrize(
    ("ending", "why"),
    [
        ("0.9,1.0\n", "in the middle of a row"),
        ("0.9,1.0", "in the middle of a row"),
        ("0.9,", "in the middle of a row"),
        ("0", "in the middle of a row"),
        ("1.0,1.0,-", "in the middle of a number"),
        ("1.0,1.0,5e-", "in the middle of a number"),
        ("1.0,1.0,0", "in the middle of a number"),
    ],
)
def test_a_last_line_that_was_cut_short_is_left_out(log, ending, why):
    log(wheels=table("time,vr,vl", WHEELS[:9]) + ending)
    found = read("gnss", LOG)
    assert (
        found.warnings[0] == f"log/wheelspeeds-1.csv:11: the file ends {why}: this line is left out"
    )
    assert given(found, Control)[-1].t == 0.8


def test_a_last_number_that_may_be_whole_is_used_and_told(log):
    sound = read("gnss", LOG)
    log(wheels=table("time,vr,vl", WHEELS)[:-1])
    found = read("gnss", LOG)
    assert same(found, sound)
    assert found.warnings == [
        "log/wheelspeeds-1.csv:12: the file ends without a line break; its last number may be cut "
        "short"
    ]


@pytest.mark.parametrize(
    ("wheels", "told"),
    [
        ("", "log/wheelspeeds-1.csv:1:1: the file is empty; it begins with the line t,vr,vl"),
        ("\n \n# nothing\n", "log/wheelspeeds-1.csv:1:1: the file is empty; it begins with the "
                             "line t,vr,vl"),
        ("t,vr,vl\n", "log/wheelspeeds-1.csv:1:1: the file holds no rows; "
                      "without wheel speeds there is nothing to localize"),
        ("0,1,1,0\n0.1,1,1,0\n", "log/wheelspeeds-1.csv:1:1: '0,1,1,0' names no columns; the first "
                                 "line says what they are: t,vr,vl (ekfsim schema recording)"),
        ("t,vr\n0,1\n", "log/wheelspeeds-1.csv:1:1: no column is named 'vl'; found 't', 'vr'"
                        + WANTED),
        ("t,vr,vll\n0,1,1\n",
         "log/wheelspeeds-1.csv:1:1: no column is named 'vl'; found 't', 'vr', 'vll'; did you "
         "mean 'vll'?" + WANTED),
        ("t,vr,vl,t\n0,1,1,0\n",
         "log/wheelspeeds-1.csv:1:1: 2 columns are named 't' or 'time'; found 't', 'vr', 'vl', "
         "'t'" + WANTED),
        ("t,vr,vl\n0,1,1\n0.1,1,x\n0.2,,1\n0.3,1,1\n",
         "log/wheelspeeds-1.csv:3:7: vl: 'x' is not a number; write e.g. 1.5\n"
         "log/wheelspeeds-1.csv:4:5: vr: nothing stands where a number belongs; write e.g. 1.5"),
        ("t,vr,vl\n0,1,1\n0.1,1\n0.2,1,1,1\n0.3,1,1\n",
         "log/wheelspeeds-1.csv:3:1: 2 columns stand in this row; it must have 3\n"
         "log/wheelspeeds-1.csv:4:1: 4 columns stand in this row; it must have 3"),
        ("t,vr,vl\n0,1\n0.1,1\n0.2,1\n", "log/wheelspeeds-1.csv:2:1: 2 columns stand in this row; "
                                         "it must have 3" + WANTED),
        ("t,vr,vl\n0,1_0,1\n0.1,0x1,1\n",
         "log/wheelspeeds-1.csv:2:3: vr: '1_0' is not a number; write e.g. 1.5\n"
         "log/wheelspeeds-1.csv:3:5: vr: '0x1' is not a number; write e.g. 1.5"),
        ("t,vr,vl\n0,0,1,5,1,5\n0,1,1,5,1,5\n",
         "log/wheelspeeds-1.csv:2:1: 6 columns stand in this row; it must have 3; if these are "
         "decimal commas, write points, or ; between the columns" + WANTED),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_with_its_place(log, wheels, told):
    log(wheels=wheels)
    with pytest.raises(InputError) as refused:
        read("gnss", LOG)
    assert str(refused.value) == told


def test_twenty_mistakes_are_told_and_the_others_counted(log):
    log(wheels="t,vr,vl\n" + "".join(f"{k},x,1\n" for k in range(50)))
    with pytest.raises(InputError) as refused:
        read("gnss", LOG)
    assert len(refused.value.mistakes) == 21
    assert (
        str(refused.value.mistakes[-1]) == "log/wheelspeeds-1.csv:21:1: and 30 more mistakes below"
    )


@pytest.mark.parametrize(
    ("raw", "told"),
    [
        (
            b"t,vr,vl\n0,1,1\n0.1,\xff,1\n",
            "3:5: the byte 0xff is not UTF-8; a log is plain text in UTF-8",
        ),
        ("t,vr,vl\n".encode("utf-16"), "1:1: the file is UTF-16, not UTF-8; save it as UTF-8"),
        (
            b"t,vr,vl\n0,1,1\n0.1,\x00,1\n0.2,1,1\n",
            "3:5: vr: '\\x00' is not a number; write e.g. 1.5",
        ),
    ],
)
def test_bytes_that_are_no_text_are_refused(log, raw, told):
    (log() / "wheelspeeds-1.csv").write_bytes(raw)
    with pytest.raises(InputError) as refused:
        read("gnss", LOG)
    assert str(refused.value) == f"log/wheelspeeds-1.csv:{told}"


def test_missing_files_and_folders_are_told(log, tmp_path):
    folder = log()
    (folder / "gnss-1.csv").rename(folder / "fixes.csv")
    for path, told in (
        (LOG, "log: no file 'gnss*.csv' in it; it would hold the satellite fixes; found fixes.csv, "
         "groundtruth-1.csv, wheelspeeds-1.csv"),
        (LOG / "fixes.csv", "log/fixes.csv: is a file; name the folder that holds "
                            "wheelspeeds*.csv and gnss*.csv and, "
                            "where there are any, groundtruth*.csv"),
        (Path("away"), "away: no such folder; name the one that holds wheelspeeds*.csv and "
                       "gnss*.csv and, "
                       "where there are any, groundtruth*.csv"),
    ):  # fmt: skip
        with pytest.raises(UsageError) as refused:
            read("gnss", path)
        assert str(refused.value) == told
    (folder / "gnss-1.csv").mkdir()
    with pytest.raises(UsageError, match="is a folder, where a file of the log belongs"):
        read("gnss", LOG)


def test_two_files_for_one_are_refused(log):
    (log() / "gnss-2.csv").write_text("t,x,y\n")
    with pytest.raises(UsageError) as refused:
        read("gnss", LOG)
    assert str(refused.value) == (
        "log: several files 'gnss*.csv' in it: gnss-1.csv, gnss-2.csv; leave one there for the "
        "satellite fixes"
    )


def test_readings_before_and_after_the_motion_are_left_out_and_counted(log):
    log(fixes=table("t,x,y", [[-1.0, 0.0, 0.0], *FIXES, [1.5, 0.0, 0.0]]))
    found = read("gnss", LOG)
    assert len(given(found, Reading)) == 4
    spans = "readings are of -1 to 1.5 s, the motion of 0 to 1 s"
    assert found.warnings == [f"log: 2 readings lie before or after the motion: left out; {spans}"]


def test_a_log_starts_where_its_truth_does(log):
    log(truth=table("t,x,y,phi", [[k / 10 + 0.02, 0.5, 0.5, 3.2] for k in range(3, 12)]))
    found = read("gnss", LOG)
    first = found.log.entries[0]
    assert first.t == 0.32
    np.testing.assert_allclose(first.truth, [0.5, 0.5, 3.2 - 2 * math.pi])
    np.testing.assert_allclose(found.log.first.mean, [0, 3.2 - 2 * math.pi, 0.5, 0.5])
    assert sum(float(entry.given.u[2]) for entry in given(found, Control)) == pytest.approx(0.68)
    assert (
        "log: starts at 0.32 s, where the truth begins: what was before is left out"
        in found.warnings
    )
    assert found.log.entries[-1].truth is not None
    log(truth=table("t,x,y,phi", [[t + 100, *pose] for t, *pose in TRUTH]))
    with pytest.raises(UsageError) as refused:
        read("gnss", LOG)
    spans = "the truth is of 100 to 101 s, the motion of 0 to 1 s"
    told = f"log: the truth and the motion have no instant in common: {spans}"
    assert str(refused.value) == f"{told}; put them on one clock, or take the truth away"


@pytest.mark.parametrize("late", [1.5, -1.5])
def test_a_truth_cut_out_of_another_part_of_a_log_is_unknown(log, late):
    log(truth=table("t,x,y,phi", [[t + late, *pose] for t, *pose in TRUTH]))
    found = read("gnss", LOG)
    assert all(entry.truth is None for entry in found.log.entries)
    assert "no instant in common" in found.warnings[0]
    assert "the truth is unknown" in found.warnings[0]


def test_a_truth_that_ends_long_before_the_log_is_told(log):
    log(wheels=table("time,vr,vl", [[k / 10, 1.0, 0.5] for k in range(40)]))
    told = "log: the truth ends 2.9 s before the motion: errors are counted until then"
    assert read("gnss", LOG).warnings == [told]


def test_without_truth_the_filter_starts_where_it_is_told(log):
    log(truth="absent")
    place = world("gnss", start=(3.0, 4.0, 0.5))
    told = replace(place.told, start_said=(True, True, True))
    found = read("gnss", LOG, replace(place, told=told))
    np.testing.assert_array_equal(found.log.first.mean, [0, 0.5, 3, 4])
    assert {entry.truth is None for entry in found.log.entries} == {True}


def test_headings_are_interpolated_the_short_way_round(log):
    log(
        truth=table(
            "t,x,y,phi",
            [
                [k / 10, 0.0, 0.0, math.pi - 0.3 + 0.1 * k - (k > 3) * 2 * math.pi]
                for k in range(11)
            ],
        )
    )
    found = read("gnss", LOG)
    for entry in found.log.entries:
        assert math.remainder(
            entry.truth[2] - (math.pi - 0.3 + entry.t), 2 * math.pi
        ) == pytest.approx(0, abs=1e-12)
        assert -math.pi < entry.truth[2] <= math.pi


def test_large_files_are_read_quickly(tmp_path):
    rng = np.random.default_rng(0)
    poses = rng.normal(size=(54_900, 21))
    poses[:, 2] = np.arange(54_900) / 100
    lines = [" ".join(map(repr, row)) for row in poses.tolist()]
    files = {
        "marker-001-poselog.txt": "\n".join([*lines, ""]),
        "marker-001-003-angles.txt": "5.005 1 0.1 -0.05\n",
    }
    folder = lay(tmp_path / "log", **files, **{"marker-001-map.txt": "0 3 3\n1 4 4\n"})
    before = time.process_time()
    assert len(read("mower", folder, world("mower", MARKS)).log.entries) == 54_902
    # s; it takes about a tenth of it, line by line it would take longer
    assert time.process_time() - before < 5
