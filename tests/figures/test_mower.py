"""The figures of document 000: what is drawn in them, and the numbers beside the print."""

import csv
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.figures.album import Album
from ekfsim.figures.mower import document as mower
from ekfsim.figures.mower.document import WAYS, as_read, draw_mower, filtered, with_ideal_angles
from ekfsim.figures.mower.pictures import blind_stretches
from ekfsim.figures.mower.runs import ALONE, Outcome, Way, as_shaken_as_told, outcomes
from ekfsim.figures.mower.tables import costs, differences
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.filters.belief import Gaussian
from ekfsim.records import Log, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.systems.drive import Course


class Kept(Album):
    """An album that keeps its figures, and writes none."""

    def add(self, figure, name, title, caption, source=None):
        self.drawn = {**getattr(self, "drawn", {}), name: figure}
        self.pages.append(caption)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return read_scene(packaged("commands")["mower"]).get()


@pytest.fixture(scope="module")
def entries(scene):
    return tuple(simulate(scene))


@pytest.fixture(scope="module")
def track(scene, entries):
    return filtered(scene, entries, "corrected")


@pytest.fixture(scope="module")
def album(scene, tmp_path_factory):
    """Its pictures of a whole run, its tables of the first 80 s of twenty."""
    kept = Kept("mower", "test", tmp_path_factory.mktemp("mower"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mower, "outcomes", lambda scene, *args: outcomes(cut(scene, 80.0), *args))
        draw_mower(scene, kept)
    return kept


def cut(scene, seconds):
    """The same drive, and no longer than that: its spiral goes on as before, its course ends."""
    way = scene.drive.course(1 / scene.world.robot.rate)
    ticks = round(seconds * scene.world.robot.rate)
    return replace(scene, drive=Cut(Course(way.speed[:ticks], way.turn_rate[:ticks], way.held)))


class Cut(NamedTuple):
    """A drive that is a course already."""

    way: Course

    def course(self, dt):
        return self.way


def rows(album, name):
    with (album.folder / f"{name}.csv").open(encoding="utf-8") as file:
        return [row[:-1] for row in csv.reader(file)][1:]  # without what made it


def line(axes, label):
    return next(line for line in axes.get_lines() if line.get_label() == label)


def test_every_figure_and_table_is_there(album):
    assert list(album.drawn) == [
        "fig4-paths",
        "fig5-markers-and-trace",
        "fig6-errors",
        "fig7-close-up",
    ]
    assert sorted(path.name for path in album.folder.iterdir()) == [
        "differences.csv",
        "readings.csv",
        "table1-errors.csv",
    ]
    assert all(len(page) > 150 for page in album.pages)


def test_every_axis_has_its_quantity_and_unit_and_every_figure_a_legend(album):
    for name, figure in album.drawn.items():
        assert figure.legends, name
        for axes in figure.axes:
            assert axes.get_ylabel().endswith(")") or axes.get_ylabel() == "visible markers", name
        assert figure.axes[-1].get_xlabel().endswith(")"), name


def test_figure_4_shows_the_whole_way_and_all_markers(scene, entries, album):
    axes = album.drawn["fig4-paths"].axes[0]
    truth = np.array([entry.truth for entry in entries if not isinstance(entry.given, Reading)])
    assert_allclose(np.column_stack(line(axes, "truth").get_data()), truth[:, :2])
    assert len(line(axes, "marker").get_xdata()) == 28
    assert len(line(axes, "estimate").get_xdata()) == 54_901
    assert axes.get_aspect() == 1


def test_figure_5_counts_the_markers_of_each_picture(entries, album):
    above, below = album.drawn["fig5-markers-and-trace"].axes
    t, seen = line(above, "markers in a picture").get_data()
    times = [entry.t for entry in entries if isinstance(entry.given, Reading)]
    assert sum(seen) == len(times)
    assert set(t) == set(times)
    assert all(instant % 2 == 0 for instant in t)
    trace = line(below, "trace of P").get_ydata()
    assert trace[0] == pytest.approx(2e-4 + 7.62e-5)  # P₀ = Q
    assert below.get_yscale() == "log"


def test_figure_6_has_the_errors_of_the_run(track, album):
    above, below = album.drawn["fig6-errors"].axes
    position, heading = above.get_lines()[0].get_ydata(), below.get_lines()[0].get_ydata()
    assert_allclose(position, track.position_error)
    assert_allclose(heading, np.degrees(track.heading_error))
    assert above.get_ylim()[1] > position.max()
    assert below.get_ylim()[1] > np.abs(heading).max()


def test_figure_6_says_why_its_largest_error_is_there(track, album):
    told = " ".join(
        next(page for page in album.pages if "position error is largest at" in page).split()
    )
    worst = track.t[np.argmax(track.position_error)]
    assert f"largest at {worst:.0f} s" in told
    times = [reading.t for reading in track.readings if reading.t <= worst]
    last = max(t for t in times if times.count(t) > 1)
    assert worst - last >= 8
    assert f"with no more than one marker in a picture since {last:.0f} s" in told


def test_figure_7_is_where_no_marker_is_seen_with_seconds_along_the_way(track, entries, album):
    axes = album.drawn["fig7-close-up"].axes[0]
    a, b = max(blind_stretches(track), key=np.ptp)
    labels = [int(text.get_text()) for text in axes.texts]
    assert labels == list(range(int(a) - 12, int(b) + 7, 2))
    at = {entry.t: entry.truth for entry in entries}
    for text, label in zip(axes.texts, labels, strict=True):
        assert_allclose(text.xy, at[float(label)][:2])


def test_table_1_stands_beside_the_print_and_has_its_pattern(album):
    """Over twenty runs: real angles near the document's, ideal ones much better in position and in
    heading."""
    table = rows(album, "table1-errors")
    printed = [row[1:] for row in table[1::2]]
    assert printed == [["0.352", "0.244", "0.123", "-0.233"], ["0.296", "3.488", "0.171", "1.301"],
                       ["0.088", "2.168", "0.029", "1.695"]]  # fmt: skip
    (real, _, ideal, _), (_, heading, _, ideal_heading) = (
        [number(cell) for cell in row[1:]] for row in table[0:4:2]
    )
    assert 0.15 < real < 0.5
    assert ideal < 0.65 * real
    assert 1.5 < heading < 4.5
    assert ideal_heading < 0.5 * heading
    assert all(" ± " in cell for row in table[::2] for cell in row[1:])


def number(cell):
    return float(cell.partition(" ")[0].replace("−", "-"))


def test_the_readings_cost_what_the_caption_says(album):
    table = {tuple(row[:2]): [number(cell) for cell in row[2:6]] for row in rows(album, "readings")}
    for mower_is in ("as it is", "as told"):
        right, listing, wrong = (
            table[mower_is, reading] for reading in ("corrected", "coded", "printed")
        )
        assert wrong[0] > 3 * right[0]
        assert wrong[2] > 50
        assert listing[1] > 1.1 * right[1]  # the heading suffers in any case
    # over-confident only where Q is the truth
    assert table["as it is", "coded"][2] < 3 < table["as told", "coded"][2]
    assert table["as told", "corrected"][2] < 3.5
    assert "below the 3 that is right, as long as Q has so much room" in " ".join(
        album.pages[-1].split()
    )
    assert "above the 3 that is right: over-confident." in " ".join(album.pages[-1].split())


def test_many_runs_in_every_way_at_once_are_each_of_them_alone(scene):
    """Errors at every fifth of a second, NEES, NIS of run 1; readings from the filters that `run`
    uses."""
    short = cut(scene, 12.0)
    together = outcomes(short, (*WAYS, Way("printed", ideal=True), Way("coded", ideal=True)), 3)
    alone = tuple(simulate(replace(short, run=1)))
    for way, outcome in together.items():
        if way is ALONE:
            track = filtered(short, alone, "corrected")
            track = replace(track, state=track.reckoned)
        else:
            track = filtered(short, with_ideal_angles(alone) if way.ideal else alone, way.reading)
        judged = Outcome.of(track)
        rows = np.isin(np.round(track.t * 100), np.arange(20, 1201, 20))
        assert_allclose(outcome.position[:, 1], judged.position[rows, 0], atol=1e-8)
        assert_allclose(outcome.heading[:, 1], judged.heading[rows, 0], atol=1e-8)
        if way is not ALONE:
            assert_allclose(
                outcome.nees[:, 1], judged.nees[rows, 0], rtol=1e-3
            )  # P is near singular under some readings
            assert outcome.nis[1] == pytest.approx(judged.nis[0], rel=1e-4)


def test_a_mower_as_told_is_shaken_as_the_filter_believes(scene):
    told = as_shaken_as_told(scene).world
    assert scene.world.robot.heading_sigma < 0.05 * scene.world.told_robot.heading_sigma
    assert told.robot == told.told_robot == scene.world.told_robot


def test_costs_are_told_run_by_run():
    def outcome(*rmse):
        return Outcome(
            np.array([rmse, rmse]),
            np.ones((2, len(rmse))),
            np.full((2, len(rmse)), 3.0),
            np.ones(len(rmse)),
        )

    of = {
        "corrected": outcome(1.0, 2.0, 4.0),
        "coded": outcome(1.1, 1.8, 4.8),
        "printed": outcome(3.0, 8.0, 20.0),
    }
    assert costs(of, "coded") == "7 % more RMSE (−10 to 20 % in single runs, worse in 2 of 3)"
    assert costs(of, "printed") == "4.0 times the RMSE (3.0 to 5.0 in single runs)"


def test_ideal_angles_are_those_of_the_truth(entries):
    for entry in with_ideal_angles(entries[:3000]):
        if isinstance(entry.given, Reading):
            assert_allclose(entry.given.z, entry.given.sensor.h(entry.truth), rtol=0, atol=0)
            assert_allclose(entry.given.sensor.linearize(entry.truth)[2], np.eye(2) * 1e-12)


def test_R_is_found_in_the_differences_and_a_bias_with_it(entries, album):
    (_, *azimuth), (_, *elevation) = rows(album, "differences")
    assert float(azimuth[1]) == pytest.approx(2.75, rel=0.1)
    assert float(elevation[1]) == pytest.approx(0.344, rel=0.1)
    assert (azimuth[2], elevation[2]) == ("2.750", "0.344")
    assert abs(float(azimuth[0])) < 0.4
    shifted = [
        replace(entry, given=replace(entry.given, z=entry.given.z + np.radians([0, 2.0])))
        for entry in entries
        if isinstance(entry.given, Reading)
    ]
    differences(shifted, album)
    assert float(rows(album, "differences")[1][1]) == pytest.approx(
        float(elevation[0]) + 2, abs=2e-3
    )


def test_a_log_is_read_with_the_derivatives_that_are_asked_for(entries):
    signs = {
        reading: {
            e.given.sensor.elevation_sign
            for e in as_read(entries[:3000], reading)
            if isinstance(e.given, Reading)
        }
        for reading in ("printed", "coded", "corrected")
    }
    assert signs == {"printed": {-1.0}, "coded": {1.0}, "corrected": {1.0}}


def test_a_recorded_log_gives_the_figures_of_its_run(scene, entries, album, tmp_path):
    """Of its first 30 s, and one without a marker."""
    some = tuple(entry for entry in entries if entry.t <= 30)
    first = filtered(scene, some, "corrected")
    for log in (some, tuple(entry for entry in some if not isinstance(entry.given, Reading))):
        kept = Kept("mower", "test", tmp_path)
        start = Gaussian(first.state[0], first.covariance[0])
        draw_mower(replace(scene, log=Log(log, start), drive=None), kept)
        truth = line(kept.drawn["fig4-paths"].axes[0], "truth").get_xdata()
        assert len(truth) == 3001
        if log is some:
            assert_allclose(
                line(kept.drawn["fig4-paths"].axes[0], "estimate").get_xdata(), first.pose[:, 0]
            )
