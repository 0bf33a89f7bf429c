"""Where the filter of a recorded log begins, and how sure it is of that."""

import math
import warnings as told_by_python

import numpy as np
import pytest
from log_worlds import lay, read, table, world

import ekfsim
from ekfsim.diagnostics.summary import Summary
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import check, read_scene
from ekfsim.files.scenes.settings import setting
from ekfsim.localization import first_belief, play
from ekfsim.views.words.closing import conclude

LANDMARKS = "6 5.0 3.0 0 0\n7 6.0 -1.0 0 0\n"
MRCLAM = {
    "Robot1_Odometry.dat": "".join(f"{k / 10:.1f} 1.0 0.0\n" for k in range(51)),
    "Robot1_Measurement.dat": "0.2 63 4.0 0.5\n",
    "Barcodes.dat": "1 5\n6 63\n7 25\n",
    "Landmark_Groundtruth.dat": LANDMARKS,
}
TRUTH = "Robot1_Groundtruth.dat"
PLAZA = {
    "odometry.csv": table("t,distance,dheading", [[k / 10, 0.1, 0.0] for k in range(1, 51)]),
    "ranges.csv": table("t,node,range", [[0.25, 6, 4.0]]),
    "nodes.csv": table("node,x,y", [[6, 5.0, 3.0], [7, 6.0, -1.0]]),
}
WAYS = {
    "odometry.csv": table(
        "t,left,right", [[k / 10, 0.1 * (k > 0), 0.1 * (k > 0)] for k in range(51)]
    ),
    "ultrasonic.csv": table("t,beam,range", [[0.5, 1, 1.5]]),
}
SPEEDS = {
    "wheelspeeds.csv": table("t,vl,vr", [[k / 10, 1.0, 1.0] for k in range(51)]),
    "gnss.csv": table("t,x,y", [[k / 2, k / 2 + 7.0, 3.0] for k in range(1, 10)]),
}
LOGS = {"mrclam": MRCLAM, "ranges": PLAZA, "pioneer": WAYS, "gnss": SPEEDS}


def poses(format, rows):
    """The file of a truth of t, x, y, heading."""
    if format == "mrclam":
        return {TRUTH: "".join(" ".join(map(repr, row)) + "\n" for row in rows)}
    return {"groundtruth.csv": table("t,x,y,heading", rows)}


def straight(*spans, step=0.1, heading=0.0):
    """A truth along x at 1 m/s that is known in some spans of time."""
    times = [t for a, b in spans for t in np.arange(a, b + step / 2, step).round(6).tolist()]
    return [[t, t + 0.0, 0.0, heading] for t in times]


def scene(format, folder, *settings, world=None):
    """The scene of a log, and the warnings."""
    found = read_scene(
        resolve(f"{format}_log", "commands"), world, folder, settings=tuple(map(setting, settings))
    )
    return found.get(), found.warnings


def believed(scene):
    """The mean pose and the standard deviations in m, m, degrees of the first belief."""
    mean, P = first_belief(scene)
    layout = scene.world.layout
    sigma = np.sqrt(np.diag(layout.pose_covariance(P)))
    return layout.pose(mean) * [1, 1, 57.29577951308232], sigma * [1, 1, 57.29577951308232]


# what is told of the start and of how sure the filter is
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("format", ["mrclam", "ranges", "pioneer"])
def test_a_log_without_truth_begins_where_it_is_told_and_as_sure(tmp_path, format):
    folder = lay(tmp_path / "log", **LOGS[format])
    start = "start.x=1.5", "start.y=2.5", "start.theta=-90"
    sigmas = "belief.sigma.x=0.5", "start.sigma.y=0.25", "belief.sigma.theta=20"
    ours, _ = scene(format, folder, *start, *sigmas)
    mean, sigma = believed(ours)
    np.testing.assert_allclose(mean, [1.5, 2.5, -90])
    np.testing.assert_allclose(sigma, [0.5, 0.25, 20])
    own, _ = scene(format, folder)
    np.testing.assert_allclose(mean - believed(own)[0] != 0, True)
    assert np.all(believed(own)[1] < sigma)


@pytest.mark.parametrize("format", LOGS)
def test_a_world_file_tells_it_as_well(tmp_path, format):
    system = {"mrclam": "landmarks"}.get(format, format)
    place = tmp_path / "place.yaml"
    place.write_text(
        f"name: place\nsystem: {system}\nstart: {{x: 9, y: 9, theta: 9}}\nbelief: {{start: {{x: 1,"
        " y: 2, theta: 30}, sigma: {x: 0.1, y: 0.2, theta: 3}}\n"
    )
    folder = lay(tmp_path / "log", **LOGS[format])
    ours, warnings = scene(format, folder, world=place)
    np.testing.assert_allclose(believed(ours), [[1, 2, 30], [0.1, 0.2, 3]])
    assert "starts" not in " ".join(warnings)
    known = lay(tmp_path / "known", **LOGS[format], **poses(format, straight((0, 5))))
    ours, _ = scene(format, known, world=place)
    np.testing.assert_allclose(believed(ours), [[1, 2, 30], [0.1, 0.2, 3]])
    assert ours.log.entries[0].truth is not None


def test_a_simulation_and_a_log_believe_alike(tmp_path):
    asked = "belief.start.x=1.5", "belief.sigma.x=3", "belief.sigma.theta=20"
    folder = lay(tmp_path / "log", **MRCLAM)
    logged, _ = scene("mrclam", folder, *asked)
    drive = read_scene(resolve("landmarks", "commands"), settings=tuple(map(setting, asked))).get()
    for ours, theirs in zip(first_belief(logged), first_belief(drive), strict=True):
        np.testing.assert_array_equal(ours, theirs)
    np.testing.assert_allclose(believed(logged)[1], [3, 0.01, 20])  # y as its document has it


def test_only_what_is_told_changes_where_the_truth_is_known(tmp_path):
    truth = poses("mrclam", straight((0, 5), heading=0.5))
    folder = lay(tmp_path / "log", **MRCLAM, **truth)
    mean, sigma = believed(scene("mrclam", folder, "start.y=2", "belief.sigma.y=4")[0])
    np.testing.assert_allclose(mean, [0, 2, math.degrees(0.5)])
    np.testing.assert_allclose(sigma, [0.01, 4, math.degrees(0.01)])


def test_no_doubt_can_be_told_too(tmp_path):
    folder = lay(tmp_path / "log", **MRCLAM)
    ours, _ = scene("mrclam", folder, "belief.sigma.theta=0")
    np.testing.assert_allclose(believed(ours)[1], [0.01, 0.01, 0], atol=1e-15)


def test_it_is_told_what_was_assumed_and_how_to_say_otherwise(tmp_path):
    folder = lay(tmp_path / "log", **MRCLAM)
    start = "--set start.x=… (y, theta)"
    sigma = "--set belief.sigma.x=… (y, theta)"
    for asked, told in (
        ((), "no truth tells where it starts: taken is (4, 2, 0°), the start of "
             f"worlds/landmarks.yaml, to within 0.01 m and 0.573°; say otherwise with {start} and "
             f"{sigma}"),
        (("start.x=1", "start.theta=-180"), "no truth tells where it starts: taken is (1, 2, "
             "180°), x and theta as told, the rest the start of worlds/landmarks.yaml, to within "
             f"0.01 m and 0.573°; say otherwise with {start} and {sigma}"),
        (("start.x=1", "start.y=0", "start.theta=45"), "starts at (1, 0, 45°) as told, to within "
             f"0.01 m and 0.573°; say otherwise with {sigma}"),
        (("start.x=1", "start.y=0", "start.theta=45", "belief.sigma.x=1", "belief.sigma.y=1",
          "belief.sigma.theta=9"), None),
    ):  # fmt: skip
        _, warnings = scene("mrclam", folder, *asked)
        about = [line for line in warnings if "starts" in line]
        assert about == ([] if told is None else [f"{folder}: {told}"])


def test_check_and_python_tell_it_too(tmp_path, monkeypatch):
    folder = lay(tmp_path / "log", **MRCLAM)
    commands = tmp_path / "own.yaml"
    world = resolve("landmarks", "worlds")
    commands.write_text(f"world: {world}\nrecording: {{format: mrclam, path: log}}\n")
    assert "no truth tells where it starts" in " ".join(check(commands).warnings)
    ours = ekfsim.load_scene(commands)
    with told_by_python.catch_warnings():
        told_by_python.simplefilter("ignore")
        other = ours.with_("start.x", 3, "belief.sigma.x", 2)
    np.testing.assert_allclose(believed(other)[0], [3, 2, 0])
    np.testing.assert_allclose(believed(other)[1][0], 2)
    assert folder.exists()


# a truth that is not always known
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("format", LOGS)
def test_a_log_begins_where_its_truth_is_first_known(tmp_path, format):
    """Known at −0.7 s, before the log, and again from 2 s on; known from 2 s on; until 3 s."""
    for spans, begins, judged in (
        (((-0.7, -0.7), (2, 5)), "starts at 2 s, where the truth is known again, after a gap from "
                                 "-0.7 s: what was before is left out", (2, 5)),
        (((2, 5),), "starts at 2 s, where the truth begins: what was before is left out", (2, 5)),
        (((0, 3),), "the truth ends 2 s before the motion: errors are counted until then", (0, 3)),
    ):  # fmt: skip
        folder = lay(tmp_path / f"log{len(spans)}{begins[:3]}", **LOGS[format],
                     **poses(format, straight(*spans)))  # fmt: skip
        ours, warnings = scene(format, folder)
        assert f"{folder}: {begins}" in warnings
        steps = list(play(ours))
        assert steps[0].entry.t == judged[0]
        known = [step for step in steps if step.entry.truth is not None]
        assert [known[0].entry.t, known[-1].entry.t] == pytest.approx(judged)
        mean = ours.world.layout.pose(steps[0].posterior.mean)
        np.testing.assert_allclose(mean, [judged[0], 0, 0], atol=1e-9)


def test_gaps_within_the_truth_are_told(tmp_path):
    truth = poses("mrclam", straight((0, 1), (2.5, 3), (4.5, 5)))
    ours, warnings = scene("mrclam", lay(tmp_path / "log", **MRCLAM, **truth))
    told = "the truth is unknown over 2 gaps, 3 s in all: no errors are counted there"
    assert f"{tmp_path}/log: {told}" in warnings
    known = [e.t for e in ours.log.entries if e.truth is not None]
    assert not [t for t in known if 1 < t < 2.5 or 3 < t < 4.5]
    assert {1.0, 2.5, 3.0, 4.5} <= set(known)


def test_a_start_that_is_told_is_the_log_s_own(tmp_path):
    folder = lay(tmp_path / "log", **MRCLAM, **poses("mrclam", straight((2, 5))))
    ours, warnings = scene("mrclam", folder, "start.x=1", "start.y=0", "start.theta=45")
    assert ours.log.entries[0].t == 0.0
    told = "the truth begins 2 s after the motion: errors are counted from then on"
    assert f"{folder}: {told}" in warnings


def test_a_truth_that_comes_seldom_is_known_in_between(tmp_path):
    """As a camera or a particle filter tells it, every 2 s: but not over a long silence."""
    seldom = poses("mrclam", straight((0, 4), step=2.0))
    ours, _ = scene("mrclam", lay(tmp_path / "log", **MRCLAM, **seldom))
    known = [entry for entry in ours.log.entries if entry.truth is not None]
    assert known[-1].t == 4.0
    assert len(known) > 40
    np.testing.assert_allclose([e.truth[0] - e.t for e in known], 0, atol=1e-9)


def test_a_truth_of_no_instant_of_the_motion_is_none(tmp_path):
    far = [[t, 0.0, 0.0, 0.0] for t in (-9.2, -9.1, -9.0, 9.0)]
    ours, warnings = scene("mrclam", lay(tmp_path / "log", **MRCLAM, **poses("mrclam", far)))
    assert {entry.truth is None for entry in ours.log.entries} == {True}
    told = "no true pose is of the time of the motion: the truth is unknown"
    assert f"{tmp_path}/log: {told}" in warnings
    assert read("mrclam", tmp_path / "log", world("mrclam")).log.entries[0].t == 0.0


# a start that is likely wrong
# ------------------------------------------------------------------------------------------


def seen_from_the_origin(folder):
    """A robot that drives 5 m along x from (0, 0), and what it sees of two landmarks each 0.2 s, of
    0.3 m and 0.02 rad noise.
    """
    rng, rows = np.random.default_rng(1), []
    for k in range(1, 25):
        for barcode, mark in ((63, (5.0, 3.0)), (25, (6.0, -1.0))):
            east, north = mark[0] - 0.2 * k, mark[1]
            r, φ = math.hypot(east, north), math.atan2(north, east)
            rows.append((0.2 * k, barcode, abs(r + rng.normal(0, 0.3)), φ + rng.normal(0, 0.02)))
    text = "".join(f"{t:.1f} {who} {r} {φ}\n" for t, who, r, φ in rows)
    return lay(folder, **{**MRCLAM, "Robot1_Measurement.dat": text})


@pytest.mark.parametrize(
    ("settings", "blamed"),
    [
        ((), True),  # it begins at (4, 2), and the gate refuses all
        (("gate=off",), True),  # and without a gate it finds its way
        (("start.x=3", "start.y=3", "start.theta=90"), True),
        (("start.x=0", "start.y=0", "start.theta=0"), False),
        (("belief.sigma.x=4", "belief.sigma.y=4", "belief.sigma.theta=20", "gate=off"), False),
        # a right start, and a sensor that is told to be sharper than it is
        (("start.x=0", "start.y=0", "start.theta=0", "gate=off",
          "sensors.rangeBearing.rangeSigma=0.01", "sensors.rangeBearing.bearingSigma=0.1"), False),
    ],
)  # fmt: skip
def test_a_start_that_the_first_readings_refute_is_named_as_the_cause(tmp_path, settings, blamed):
    ours, _ = scene("mrclam", seen_from_the_origin(tmp_path / "log"), *settings)
    summary = Summary.of(ours)
    for _ in summary.following(play(ours)):
        pass
    (verdict, *cause) = conclude(summary).splitlines()[-1 - blamed :]
    assert verdict.startswith("Verdict: ")
    assert [line.partition(":")[0] for line in cause] == ["Likely cause"] * blamed
    if blamed:
        assert " per number read in the first 10 readings; say where it is with " in cause[0]


def test_where_the_truth_tells_the_start_it_is_not_blamed(tmp_path):
    folder = lay(seen_from_the_origin(tmp_path / "log"), **poses("mrclam", straight((0, 5))))
    ours, _ = scene("mrclam", folder, "sensors.rangeBearing.rangeSigma=0.001")
    summary = Summary.of(ours)
    for _ in summary.following(play(ours)):
        pass
    assert "Likely cause" not in conclude(summary)
    assert ours.log.start_known
