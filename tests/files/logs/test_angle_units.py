"""Degrees in place of radians: read so and told where the numbers can be nothing else."""

import contextlib
import math

import numpy as np
import pytest
from log_worlds import errors, lay, shared, steps_of, world

from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log
from ekfsim.files.logs.tables.angles import are_degrees_of_course
from ekfsim.records import Reading

SOME = 4000  # rows


def degrees(text, column, separator=None):
    """The same table with one of its columns in degrees."""
    rows = []
    for line in text.splitlines():
        fields = line.split(separator)
        with contextlib.suppress(ValueError):  # a first line of names
            fields[column] = repr(math.degrees(float(fields[column])))
        rows.append((separator or "\t").join(fields))
    return "\n".join([*rows, ""])


def mrclam(folder, changed=None, column=0):
    there = shared("mrclam6_robot1")
    files = {}
    for name in ("Odometry", "Measurement", "Groundtruth"):
        lines = (there / f"Robot1_{name}.dat").read_text().splitlines()
        text = "\n".join([*[one for one in lines if one[:1] != "#"][:SOME], ""])
        files[f"Robot1_{name}.dat"] = degrees(text, column) if name == changed else text
    for name in ("Barcodes.dat", "Landmark_Groundtruth.dat"):
        files[name] = (there / name).read_text()
    return lay(folder, **files)


@pytest.mark.parametrize(
    ("file", "column", "name"),
    [
        ("Odometry", 2, "turn rate"),
        ("Measurement", 3, "bearing"),
        ("Groundtruth", 3, "orientation"),
    ],
)
def test_one_file_of_a_real_log_in_degrees_changes_no_estimate(tmp_path, file, column, name):
    sound, scene, before = steps_of("mrclam", mrclam(tmp_path / "rad"))
    found, _, warnings = steps_of("mrclam", mrclam(tmp_path / "deg", file, column))
    ours, theirs = (errors(steps, scene.world.layout) for steps in (found, sound))
    np.testing.assert_allclose(ours, theirs, atol=1e-9)
    (told,) = (one for one in warnings if "degrees" in one)
    assert f"{file}.dat: {name} is taken as degrees" in told
    assert told.endswith("say otherwise with --set recording.angleUnit=radians")
    assert not any("degrees" in one for one in before)


def test_the_strides_of_a_mower_in_degrees(tmp_path):
    there = shared("plaza2_mower_ranges")
    files = {path.name: path.read_text() for path in there.glob("*.csv")}
    for name, column in (("odometry.csv", 2), ("groundtruth.csv", 3)):
        files[name] = degrees(files[name], column, ",")
    sound, found = (
        read_log(RecordingKeys(format="ranges"), folder, world("ranges"), "corrected")
        for folder in (there, lay(tmp_path / "deg", **files))
    )
    for ours, theirs in zip(found.log.entries, sound.log.entries, strict=True):
        np.testing.assert_allclose(ours.truth, theirs.truth, atol=1e-9)
        assert type(ours.given) is type(theirs.given)
        if ours.given is not None and not isinstance(ours.given, Reading):
            np.testing.assert_allclose(ours.given.u, theirs.given.u, atol=1e-12)
    assert sum("is taken as degrees" in one for one in found.warnings) == 2


def test_what_is_said_counts_for_every_file(tmp_path):
    text = "t,x,y,heading\n" + "".join(f"{k / 10},{k},0,{k / 100}\n" for k in range(9))
    files = {
        "wheelspeeds.csv": "t,vr,vl\n" + "".join(f"{k / 10},1,1\n" for k in range(9)),
        "gnss.csv": "t,x,y\n0.1,0,0\n0.2,0,0\n0.3,0,0\n",
        "groundtruth.csv": degrees(text, 3, ","),
    }
    folder = lay(tmp_path / "log", **files)
    recording = RecordingKeys(format="gnss", angleUnit="degrees")
    found = read_log(recording, folder, world("gnss"), "corrected")
    assert found.warnings == []
    assert found.log.entries[-1].truth[2] == pytest.approx(0.08)
    still = read_log(RecordingKeys(format="gnss"), folder, world("gnss"), "corrected")
    assert still.log.entries[-1].truth[2] == pytest.approx(math.degrees(0.08) - 2 * math.pi)
    # which none can tell


@pytest.mark.parametrize(
    ("turns", "backwards"), [(0.0, False), (0.2, False), (0.2, True), (3.0, False), (3.0, True)]
)
def test_headings_are_degrees_where_they_lead_along_the_way_so_and_not_otherwise(turns, backwards):
    θ = np.linspace(0.7, 0.7 + 2 * math.pi * turns, 500)
    x, y = (np.cumsum(0.05 * function(θ)) for function in (np.cos, np.sin))
    θ = θ + math.pi * backwards
    assert are_degrees_of_course(x, y, np.degrees(θ))
    assert not are_degrees_of_course(x, y, θ)  # beyond a turn, too: unwrapped
    assert not are_degrees_of_course(0 * x, 0 * y, np.degrees(θ))  # a robot at rest tells nothing
    folded = (np.degrees(θ) + 180) % 360 - 180
    assert are_degrees_of_course(x, y, folded) or turns == 0


def test_a_bearing_a_turn_too_far_is_still_radians(tmp_path):
    folder = mrclam(tmp_path / "log")
    file = folder / "Robot1_Measurement.dat"
    rows = [line.split() for line in file.read_text().splitlines()]
    file.write_text("".join(f"{t} {n} {r} {float(φ) + 2 * math.pi}\n" for t, n, r, φ in rows))
    assert not any("degrees" in one for one in steps_of("mrclam", folder)[2])
