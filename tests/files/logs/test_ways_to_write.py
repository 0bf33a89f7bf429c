"""However a table is written, it is the same table; what was made of it is told."""

import numpy as np
import pytest
from log_worlds import PYLON, lay, read, shared, world

from ekfsim.errors import InputError
from ekfsim.files.logs.tables.names import named

ODOMETRY = "\n".join(f"{k / 10} {0.1 + k / 100} 0.25" for k in range(6)) + "\n"
MEASUREMENT = "0.2 63 2.5 0.1\n0.35 63 2.4 0.2\n0.4 63 2.4 0.2\n0.45 63 2.4 -0.2\n"
GROUNDTRUTH = "\n".join(f"{k / 10} {k / 100} 0.5 0.125" for k in range(6)) + "\n"
FILES = {
    "Robot3_Odometry.dat": ODOMETRY,
    "Robot3_Measurement.dat": MEASUREMENT,
    "Robot3_Groundtruth.dat": GROUNDTRUTH,
    "Barcodes.dat": "7 63\n8 70\n9 71\n",
    "Landmark_Groundtruth.dat": "7 2.0 0.5 0 0\n8 2.5 0.5 0 0\n9 3.0 0.5 0 0\n",
}
NAMES = {
    "Robot3_Odometry.dat": "Time [s];Forward Velocity (m/s);Omega [rad/s]",
    "Robot3_Measurement.dat": "timestamp;barcode;range;bearing",
    "Robot3_Groundtruth.dat": "time;x;y;theta",
    "Barcodes.dat": "Subject #;Barcode #",
    "Landmark_Groundtruth.dat": "subject;x;y;sdx;sdy",
}


def changed(text, change):
    return "".join(change(line) + "\n" for line in text.splitlines())


def entries(found):
    return [
        (one.t, getattr(one.given, "u", None), getattr(one.given, "z", None), one.truth)
        for one in found.log.entries
    ]


def same(found, other):
    assert len(found.log.entries) == len(other.log.entries)
    for mine, theirs in zip(entries(found), entries(other), strict=True):
        for a, b in zip(mine, theirs, strict=True):
            assert (a is None) == (b is None)
            if a is not None:
                np.testing.assert_array_equal(a, b)


WAYS = {
    "semicolons": (lambda line: line.replace(" ", ";"), ""),
    "tabs": (lambda line: line.replace(" ", "\t"), ""),
    "commas": (lambda line: line.replace(" ", ","), ""),
    "commas and blanks": (lambda line: line.replace(" ", ", "), ""),
    "many blanks": (lambda line: "  " + line.replace(" ", "   "), ""),
    "commas at the end": (lambda line: line.replace(" ", ",") + ",", ""),
    "decimal commas": (lambda line: line.replace(".", ",").replace(" ", " ; "), "decimal points"),
    "decimal commas, tabs": (lambda line: line.replace(".", ",").replace(" ", "\t"), "decimal"),
    "decimal commas, blanks": (lambda line: line.replace(".", ","), "decimal points"),
    "quotes": (lambda line: ",".join(f'"{field}"' for field in line.split()), ""),
    "quotes, decimal commas": (
        lambda line: ",".join(f'"{field.replace(".", ",")}"' for field in line.split()), "",
    ),
}  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_what_stands_between_the_columns_is_found(tmp_path, way):
    change, told = WAYS[way]
    sound = read("mrclam", lay(tmp_path / "sound", **FILES))
    other = {name: changed(text, change) for name, text in FILES.items()}
    found = read("mrclam", lay(tmp_path / "other", **other))
    same(found, sound)
    assert all(told in one for one in found.warnings)
    assert bool(found.warnings) == bool(told)


def test_a_first_line_of_names_in_a_file_that_needs_none(tmp_path):
    sound = read("mrclam", lay(tmp_path / "sound", **FILES))
    headed = {name: NAMES[name] + "\n" + text.replace(" ", ";") for name, text in FILES.items()}
    headed["Robot3_Odometry.dat"] = "v,omega,t\n" + "".join(
        f"{v},{ω},{t}\n" for t, v, ω in (row.split() for row in ODOMETRY.splitlines())
    )
    found = read("mrclam", lay(tmp_path / "named", **headed))
    same(found, sound)
    assert len(found.warnings) == 5
    assert any("'v' is taken as speed, 'omega' is taken as turn rate" in w for w in found.warnings)
    assert any("the first line names the columns" in one for one in found.warnings)
    odd = {**FILES, "Robot3_Odometry.dat": "by hand;on;monday\n" + ODOMETRY}
    found = read("mrclam", lay(tmp_path / "odd", **odd))
    same(found, sound)
    assert "the first line is no row of numbers: left out" in found.warnings[0]


def ranges(folder, **changes):
    rows = [(round(k / 10, 1), 0.1, 0.01) for k in range(1, 8)]
    files = {
        "odometry.csv": "t,distance,dheading\n" + "".join(f"{t},{d},{a}\n" for t, d, a in rows),
        "ranges.csv": "t,node,range\n0.2,1,2.5\n0.4,1,2.5\n0.6,2,3.5\n0.7,1,2.5\n",
        "nodes.csv": "node,x,y\n1,2.5,0.5\n2,3.5,0.5\n3,0,0\n4,1,1\n",
        **changes,
    }
    return read("ranges", lay(folder, **files))


def test_names_of_other_make_are_taken_where_they_leave_no_doubt_and_told(tmp_path):
    sound = ranges(tmp_path / "sound")
    rows = "".join(f"{t * 100},{a},{d}\n" for t, d, a in ((k, 10, 0.01) for k in range(1, 8)))
    found = ranges(
        tmp_path / "other",
        **{
            "odometry.csv": "Timestamp_ms,Turn [rad],ds_cm\n" + rows,
            "nodes.csv": "ID,Easting,Northing\n1,2.5,0.5\n2,3.5,0.5\n3,0,0\n4,1,1\n",
        },
    )
    same(found, sound)
    told = "\n".join(found.warnings)
    assert "'timestamp_ms' is taken as t in ms" in told
    assert "'ds_cm' is taken as distance in cm" in told
    assert "'easting' is taken as x, 'northing' is taken as y" in told


def test_without_a_first_line_the_columns_go_by_their_places(tmp_path):
    sound = ranges(tmp_path / "sound")
    bare = {"nodes.csv": "1,2.5,0.5\n2,3.5,0.5\n3,0,0\n4,1,1\n"}
    found = ranges(tmp_path / "bare", **bare)
    same(found, sound)
    assert found.warnings[0].endswith(
        "nodes.csv:1: no first line names the columns: taken as node,x,y"
    )


@pytest.mark.parametrize("comment", ["# node, x, y", "%node,x,y", "# by hand\n# id,y,x"])
def test_a_comment_that_names_all_columns_is_their_first_line(tmp_path, comment):
    sound = ranges(tmp_path / "sound")
    rows = ["1,2.5,0.5", "2,3.5,0.5", "3,0,0", "4,1,1"]
    if comment.endswith("id,y,x"):
        rows = ["1,0.5,2.5", "2,0.5,3.5", "3,0,0", "4,1,1"]
    found = ranges(tmp_path / "log", **{"nodes.csv": "\n".join([comment, *rows, ""])})
    same(found, sound)
    assert not any("no first line" in told for told in found.warnings)


@pytest.mark.parametrize(
    ("nodes", "wrong"),
    [
        ("node,x,alt\n1,2,3\n", "no column is named 'y'; found 'node', 'x', 'alt'"),
        ("1,2,3,4\n5,6,7,8\n", "'1,2,3,4' names no columns; the first line says what they are"),
        ("node,x,east,y\n1,2\n3,4\n", "2 columns stand in this row; it must have 4"),
        ("node,easting,east,y\n1,2,3,4\n", "2 columns are named 'x'"),
        ("", "the file is empty; it begins with the line node,x,y"),
    ],
)
def test_a_refused_file_is_answered_with_what_is_wanted(tmp_path, nodes, wrong):
    with pytest.raises(InputError) as refused:
        ranges(tmp_path / "log", **{"nodes.csv": nodes})
    assert wrong in str(refused.value)
    assert "node" in str(refused.value).partition("; ")[2]


@pytest.mark.parametrize("change", [",", ";", "\t", " ; ", "names", "decimal commas"])
def test_a_pylon_log_however_it_is_written(tmp_path, change):
    rows = (shared("pylon") / "2020_2_26__17_21_59_filtered.csv").read_text().splitlines()[:60]
    fields = [row.rstrip(",").split(",") for row in rows]
    sound = read("pylon", lay(tmp_path / "sound", **{"a.csv": "\n".join([*rows, ""])}))
    header, between = [], change
    if change == "names":
        names = "X,Y,Z,Time Stamp,Latitude,Longitude,Yaw,Pitch,Roll,AccelX,AccelY,AccelZ"
        header, between = [names], ","
    if change == "decimal commas":
        fields = [[field.replace(".", ",") for field in row] for row in fields]
        between = ";"
    text = "\n".join([*header, *(between.join(row) for row in fields), ""])
    found = read("pylon", lay(tmp_path / "other", **{"b.csv": text}), world("pylon", PYLON))
    same(found, sound)


def test_units_in_names():
    assert named("Time_ns")[1:] == ("time", "ns")
    assert named('"Yaw Rate [deg/s]"')[1:] == ("yaw_rate", "degrees/s")
    assert named("sigma_x")[1:] == ("sigma_x", None)
    assert named("v (m/s)")[1:] == ("v", "m/s")


@pytest.mark.parametrize(
    ("head", "factor"), [("v [m/s]", 1), ("v_ms", 1), ("v (cm/s)", 100), ("v [km/h]", 3.6)]
)
def test_speeds_are_in_what_the_first_line_says(tmp_path, head, factor):
    sound = read("mrclam", lay(tmp_path / "sound", **FILES))
    rows = [line.split() for line in ODOMETRY.splitlines()]
    text = "".join(f"{t},{float(v) * factor!r},{w}\n" for t, v, w in rows)
    odometry = {"Robot3_Odometry.dat": f"t,{head},omega\n{text}"}
    found = read("mrclam", lay(tmp_path / "other", **{**FILES, **odometry}))
    for (_, one, _, _), (_, other, _, _) in zip(entries(found), entries(sound), strict=True):
        if one is not None:
            np.testing.assert_allclose(one, other, rtol=1e-12)
