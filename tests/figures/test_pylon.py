"""Document 004's figures: the authors' filter to the digit, and what its NIS is made of."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from kept import Kept

from ekfsim.errors import UsageError
from ekfsim.figures.pylon.document import draw_pylon
from ekfsim.figures.pylon.runs import (
    Runs,
    Told,
    by_the_letter,
    every_other,
    in_its_own_frame,
    lidar_alone,
    timed,
    turned_by_the_yaw_of,
)
from ekfsim.figures.pylon.sight import Innovations
from ekfsim.figures.pylon.what_is_left import Tries
from ekfsim.figures.track import rmse
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.records import Control, Log, Reading
from ekfsim.systems.drives import Square, Stretch, Stretches

LOG = (
    Path(__file__).resolve().parents[2]
    / ".."
    / "shared"
    / "data"
    / "pylon"
    / "2020_2_26__17_21_59_filtered.csv"
)
LOGGED = pytest.mark.skipif(not LOG.is_file(), reason="the recorded logs are not here")
NAMES = [
    "fig2-paths", "fig3-yaw", "fig4-tracking", "fig5-ellipses", "fig6-variances", "fig7-variances",
    "fig8-nis",
    "fig9-what-is-left",
]  # fmt: skip


def drawn(scene, folder):
    album = Kept("pylon", "test", folder)
    draw_pylon(scene, album)
    return album


def fast(**changed):
    return replace(
        load_scene("pylon"), drive=Square(10.0, 2.0, math.radians(90), clockwise=True), **changed
    )


def log(reading="corrected"):
    return load_scene("pylon_log", log=LOG, reading=reading)


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    return drawn(fast(), tmp_path_factory.mktemp("twin"))


@pytest.fixture(scope="module")
def logged(tmp_path_factory):
    return drawn(log("coded"), tmp_path_factory.mktemp("log"))


def row(rows, start):
    return next(numbers for name, numbers in rows.items() if name.startswith(start))


def test_a_variance_that_is_constant_is_no_noise_of_the_last_digit(twin):
    for name in ("fig6-variances", "fig7-variances"):
        for axes in twin.drawn[name].axes:
            low, high = axes.get_ylim()
            assert high >= 3.9 * low


def test_every_figure_has_its_units_and_its_caption(twin):
    assert list(twin.drawn) == NAMES
    for name, label in (
        ("fig3-yaw", "yaw θ (degrees, counter-clockwise)"),
        ("fig4-tracking", "distance to the expected path (m)"),
        ("fig6-variances", "variance of x (m²)"),
        ("fig7-variances", "variance of θ̇ (rad²/s²)"),
        ("fig8-nis", "NIS per number read"),
    ):
        assert twin.drawn[name].axes[0].get_ylabel() == label
    assert all(
        "printed figure" in twin.captions[name] or "Not in the document" in twin.captions[name]
        for name in NAMES
        if name != "fig4-tracking"
    )
    assert "the document says about 0.2 m" in twin.captions["fig4-tracking"]


def test_figure_2_draws_the_expected_path_the_gps_and_the_estimate(twin):
    labels = [line.get_label() for line in twin.drawn["fig2-paths"].axes[0].lines]
    assert labels == [
        "expected path",
        "GPS, recorded and not used",
        "truth",
        "estimate",
        "pylon",
        "start",
    ]
    assert twin.line("fig2-paths", "expected").get_xydata().tolist() == [
        [0, 0],
        [10, 0],
        [10, -10],
        [0, -10],
        [0, 0],
    ]


def test_figure_4_is_equations_11_and_12(twin):
    estimate = twin.line("fig2-paths", "estimate").get_xydata()[1:]
    x, y = estimate.T
    beside = np.minimum.reduce([abs(x - 10), abs(x), abs(y + 10), abs(y)])
    corner = np.hypot(np.minimum(abs(x), abs(x - 10)), np.minimum(abs(y), abs(y + 10)))
    outside = ((x < 0) | (x > 10)) & ((y < -10) | (y > 0))
    error = np.where(outside, corner, beside)
    assert twin.line("fig4-tracking", "error").get_ydata() == pytest.approx(error)
    so_far = twin.line("fig4-tracking", "RMSE").get_ydata()
    assert so_far == pytest.approx(np.sqrt(np.cumsum(error**2) / np.arange(1, len(error) + 1)))


def test_no_legend_hides_and_no_axis_cuts_what_the_captions_speak_of(twin):
    for name in ("fig4-tracking", "fig9-what-is-left"):
        figure = twin.drawn[name]
        figure.draw_without_rendering()
        axes = figure.axes[0]
        # it stands below
        assert axes.get_legend().get_window_extent().y1 < axes.get_window_extent().y0
    low, high = twin.drawn["fig8-nis"].axes[0].get_ylim()
    for label in ("coded", "corrected"):
        values = twin.line("fig8-nis", label).get_ydata()
        assert low < values[values > 0].min() <= values.max() < high


def test_figure_5_says_that_it_draws_the_authors_covariances_100_times_larger(twin):
    left, right = twin.drawn["fig5-ellipses"].axes
    assert "100 times larger" in left.get_title()
    assert "as they are" in right.get_title()
    track = Runs.of(fast()).tracks["coded"]
    at = track.pose[np.abs(track.pose[:, :2] - [0, -10]).max(axis=1) < 2.0, :2]
    ellipses = left.collections[0].get_segments()
    assert len(ellipses) == len(at) > 10
    P = track.pose_covariance[np.abs(track.pose[:, :2] - [0, -10]).max(axis=1) < 2.0][5, :2, :2]
    reach = np.hypot(*(ellipses[5] - at[5]).T).max()
    assert reach == pytest.approx(2.4816 * 10 * np.sqrt(np.linalg.eigvalsh(P)[-1]), rel=1e-3)


def test_figures_6_and_7_hold_every_correction_against_every_other(twin):
    told = Told.of(fast(), "corrected")
    every, other = told.track(), told.but(every_other(told.entries)).track()
    for name, panel, i in (
        ("fig6-variances", 0, 1),
        ("fig6-variances", 3, 2),
        ("fig7-variances", 1, 5),
    ):
        axes = twin.drawn[name].axes[panel]
        lines = {line.get_label(): line for line in axes.lines}
        for label, track, marker, colour in (
            ("every correction", every, "^", "#0072B2"), ("every other correction", other, "o",
            "#CC0000")
        ):  # fmt: skip
            assert lines[label].get_ydata() == pytest.approx(track.covariance[1:41, i, i])
            assert (lines[label].get_marker(), lines[label].get_color()) == (marker, colour)
    assert len(other.readings) == math.ceil(len(every.readings) / 2)


def test_the_twin_is_consistent_only_where_R_knows_of_the_yaw_error(twin):
    rows, left = twin.rows("readings"), twin.rows("what-is-left")
    assert float(row(rows, "corrected: ")["mean NIS per number"]) == pytest.approx(1, abs=0.2)
    assert float(row(rows, "coded: ")["mean NIS per number"]) > 25
    assert float(row(left, "mean NIS over 40")["measured"]) == pytest.approx(1.05, abs=0.05)
    parts = [float(row(left, f"the part a{part}")["measured"]) for part in ("long", "cross")]
    assert sum(parts) / 2 == pytest.approx(
        float(left["mean NIS per number read"]["measured"]), abs=0.011
    )
    assert float(row(left, "the same from the median")["measured"].split()[0]) == pytest.approx(
        7.5, rel=0.25
    )


def test_innovations_are_split_along_and_across_the_line_of_sight():
    steps = [step for step in play(fast()) if step.correction is not None]
    found = Innovations.of(steps)
    assert found.nis == pytest.approx([float(step.correction.nis) for step in steps])
    one = steps[30].correction
    assert found.range[30] == pytest.approx(np.hypot(*steps[30].entry.given.z))
    e = one.predicted / np.hypot(*one.predicted)
    assert found.along[30] == pytest.approx(e @ one.innovation / np.sqrt(e @ one.S @ e))
    assert found.sideways[30] == pytest.approx(e[0] * one.innovation[1] - e[1] * one.innovation[0])


def test_a_yaw_that_is_late_shows_in_turns():
    right = Told.of(fast(), "corrected")
    turned, late, before = turned_by_the_yaw_of(right.entries, -1), [], 0.0
    for entry in turned:
        if isinstance(entry.given, Control):
            u = entry.given.u.copy()
            u[2], before = before, u[2]
            entry = replace(entry, given=replace(entry.given, u=u))
        late.append(entry)
    for told, best in ((right, 1), (right.but(late), 2)):
        across = [float(number) for number in Tries.of(told).across_in_turns.split(", ")]
        assert np.argmin(across) == best


def test_logs_are_told_otherwise():
    told = Told.of(fast(), "coded")
    constant = list(timed(told.entries, 0.25))
    assert {entry.given.u[3] for entry in constant if isinstance(entry.given, Control)} == {0.25}
    stamped = [
        entry.given.u[3] for entry in timed(constant, None) if isinstance(entry.given, Control)
    ]
    assert stamped == pytest.approx(np.full(len(stamped), 0.1))
    read = [entry.given.z for entry in told.entries if isinstance(entry.given, Reading)]
    turned = [
        entry.given.z for entry in by_the_letter(told.entries) if isinstance(entry.given, Reading)
    ]
    assert [np.hypot(*z) for z in turned] == pytest.approx([np.hypot(*z) for z in read])
    assert not np.allclose(turned[0], read[0])
    assert lidar_alone(told)[5] == pytest.approx([5, -5] - read[5])


def test_too_short_a_run_is_refused(tmp_path):
    stub = replace(load_scene("pylon"), drive=Stretches((Stretch(1.0, 0.0, 1.0),)))
    with pytest.raises(
        UsageError, match=r"pylon\.yaml: 10 readings of the pylon are too few to draw; 30 will do"
    ):
        drawn(stub, tmp_path)


def test_a_run_that_stays_away_from_the_corner_has_no_figure_5(tmp_path, monkeypatch):
    monkeypatch.setattr("ekfsim.figures.pylon.yaw.RUNS", 2)
    album = drawn(
        replace(load_scene("pylon"), drive=Stretches((Stretch(1.0, 0.0, 5.0),))), tmp_path
    )
    assert list(album.drawn) == [name for name in NAMES if name != "fig5-ellipses"]
    assert any("does not come near the south-west corner" in page for page in album.pages)
    assert "nan" not in "".join(album.captions.values())


@LOGGED
def test_on_the_authors_log_the_coded_reading_is_their_filter(logged):
    rows = logged.rows("readings")
    for start in (
        "coded: ",
        "coded, every other",
        "coded, dt from",
        "printed: ",
        "lidar and yaw",
        "GPS",
    ):
        found = row(rows, start)
        assert float(found["path RMSE (m)"]) == pytest.approx(
            float(found["the same of the authors' own program (m)"]), abs=1.1e-6
        )
    coded = row(rows, "coded: ")
    assert (float(coded["mean (m)"]), float(coded["largest (m)"])) == pytest.approx(
        (0.191488, 1.0976), abs=1e-4
    )
    assert logged.line("fig4-tracking", "RMSE").get_ydata()[-1] == pytest.approx(
        0.230198957, abs=1e-9
    )
    assert float(coded["mean NIS per number"]) == pytest.approx(22, abs=0.5)
    assert float(row(rows, "corrected: ")["mean NIS per number"]) == pytest.approx(3, abs=0.1)
    assert "meet" in logged.captions["fig6-variances"]
    assert logged.captions["fig6-variances"].endswith("So they do here.")


def test_the_numbers_of_the_authors_program_stand_beside_their_own_log_alone(twin):
    assert not any(
        "authors' own program" in column for column in next(iter(twin.rows("readings").values()))
    )


@LOGGED
def test_another_log_is_not_held_against_the_numbers_of_the_published_one(tmp_path):
    own = log("coded")
    shorter = replace(own, log=Log(own.log.entries[:-200], own.log.first))
    assert Runs.of(own).published
    assert not Runs.of(shorter).published


def test_the_yaw_filter_halves_no_position_but_the_heading(twin):
    turned, own = twin.rows("yaw-filter").values()
    at, off = ([float(row["RMSE position (m)"].split()[0]) for row in (turned, own)],
               [float(row["RMSE heading (degrees)"].split()[0]) for row in (turned,
               own)])  # fmt: skip
    assert at[1] == pytest.approx(at[0], rel=0.02)
    assert off[1] < 0.8 * off[0]
    assert "smaller in 100 of 100 runs" in " ".join("".join(twin.pages).split())


def test_read_in_its_own_frame_a_run_is_as_that_of_the_sensor_lidar():
    """The same noises are drawn for either, in another frame: alike on the whole, not reading by
    reading."""
    told = Told.of(fast(), "corrected")
    turned_back = told.but(in_its_own_frame(told.entries)).track()
    own = Told.of(
        replace(fast(), world=load_scene("pylon", world="pylon-lidar").world), "corrected"
    ).track()
    assert rmse(turned_back.position_error) == pytest.approx(rmse(own.position_error), rel=0.1)
    assert rmse(turned_back.heading_error) == pytest.approx(rmse(own.heading_error), rel=0.05)


@LOGGED
def test_the_recorded_log_is_read_in_either_frame():
    read = load_scene("pylon_log", log=LOG, world="pylon-lidar").log.entries
    for one, other in zip(in_its_own_frame(log().log.entries), read, strict=True):
        if isinstance(one.given, Reading):
            assert one.given.sensor == other.given.sensor
            assert one.given.z == pytest.approx(other.given.z, abs=1e-12)


@LOGGED
def test_what_is_left_on_the_authors_log_is_the_range(logged):
    left = logged.rows("what-is-left")
    assert float(row(left, "the part along")["measured"]) > 5
    assert float(row(left, "the part across")["measured"]) < 1
    # stated: 7.5 mm
    assert float(row(left, "σ of a range")["measured"].split()[0]) == pytest.approx(20.3, abs=0.1)
    assert float(row(left, "mean NIS, were")["measured"]) < 1.25


@LOGGED
@pytest.mark.parametrize("asked", ["corrected", "coded", "printed"])
def test_a_log_is_retold_as_its_reader_reads_it(asked):
    for reading in ("corrected", "coded"):
        told, read = Told.of(log(asked), reading).entries, log(reading).log.entries
        for one, other in zip(told, read, strict=True):
            match one.given, other.given:
                case Control(motion, u), Control(as_read, v):
                    assert motion == as_read
                    assert u == pytest.approx(v, abs=1e-12)
                case Reading(sensor, z), Reading(as_read, y):
                    assert sensor == as_read
                    assert np.array_equal(z, y)
                case _:
                    assert one.given is other.given is None
