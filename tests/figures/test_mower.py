"""The figures of document 000: what is drawn in them, and the numbers beside the print."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.figures.album import Album
from ekfsim.figures.mower import as_read, draw_mower, filtered, with_ideal_angles
from ekfsim.figures.mower_pictures import blind_stretches
from ekfsim.files.load import read_scene
from ekfsim.files.packaged import packaged
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import play
from ekfsim.records import Log, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import simulate


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
def album(scene, entries, tmp_path_factory):
    kept = Kept("mower", "test", tmp_path_factory.mktemp("mower"))
    draw_mower(scene, kept)
    return kept


def rows(album, name):
    with (album.folder / f"{name}.csv").open(encoding="utf-8") as file:
        return [row[:-1] for row in csv.reader(file)][1:]  # without what made it


def line(axes, label):
    return next(line for line in axes.get_lines() if line.get_label() == label)


def test_every_figure_and_table_is_there(album):
    assert list(album.drawn) == ["fig4-paths", "fig5-markers-and-trace", "fig6-errors", "fig7-close-up"]
    assert sorted(path.name for path in album.folder.iterdir()) == ["readings.csv", "table1-errors.csv"]
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
    estimate = np.column_stack(line(axes, "estimate").get_data())
    assert len(estimate) == 54_901
    assert np.hypot(*(estimate - truth[:, :2]).T).mean() == pytest.approx(
        float(rows(album, "table1-errors")[0][1]), abs=1e-3
    )
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


def test_figure_6_has_the_errors_of_the_table(album):
    above, below = album.drawn["fig6-errors"].axes
    table = rows(album, "table1-errors")
    position, heading = above.get_lines()[0].get_ydata(), below.get_lines()[0].get_ydata()
    for row, statistic in ((0, np.mean), (2, np.std), (4, np.var)):
        assert table[row][1:3] == [f"{statistic(e):.3f}" for e in (position, heading)]
    assert above.get_ylim()[1] > position.max()
    assert below.get_ylim()[1] > np.abs(heading).max()


def test_figure_7_is_where_no_marker_is_seen_with_seconds_along_the_way(scene, entries, album):
    axes = album.drawn["fig7-close-up"].axes[0]
    a, b = max(blind_stretches(filtered(scene, entries, "corrected")), key=np.ptp)
    labels = [int(text.get_text()) for text in axes.texts]
    assert labels == list(range(int(a) - 12, int(b) + 7, 2))
    at = {entry.t: entry.truth for entry in entries}
    for text, label in zip(axes.texts, labels, strict=True):
        assert_allclose(text.xy, at[float(label)][:2])


def test_table_1_stands_beside_the_print(album):
    """Real angles as in the document, to some extent; ideal ones halve the mean position error."""
    table = rows(album, "table1-errors")
    printed = [row[1:] for row in table[1::2]]
    assert printed == [["0.352", "0.244", "0.123", "-0.233"], ["0.296", "3.488", "0.171", "1.301"],
                       ["0.088", "2.168", "0.029", "1.695"]]  # fmt: skip
    real, ideal = float(table[0][1]), float(table[0][3])
    assert 0.2 < real < 0.6
    assert ideal < 0.7 * real
    assert float(table[4][1]) == pytest.approx(float(table[2][1]) ** 2, abs=2e-3)


def test_the_readings_cost_what_the_caption_says(album):
    table = {row[0]: [float(cell) for cell in row[1:5]] for row in rows(album, "readings")}
    right, listing, wrong = (table[reading] for reading in ("corrected", "coded", "printed"))
    assert right[0] < listing[0] < wrong[0]
    assert 1 < right[2] < 4  # NEES of 3 degrees of freedom
    assert 1 < right[3] < 2.5  # NIS of 2
    assert listing[2] > 1.3 * right[2]
    assert wrong[2] > 50


def test_the_corrected_row_is_the_run_itself(scene, album):
    error = []
    for step in play(scene):
        if not isinstance(step.entry.given, Reading):
            error.append(None)
        error[-1] = np.hypot(*(step.posterior.mean - step.entry.truth)[:2])
    row = next(row for row in rows(album, "readings") if row[0] == "corrected")
    assert row[1] == f"{np.sqrt(np.mean(np.square(error))):.3f}"


def test_ideal_angles_are_those_of_the_truth(entries):
    for entry in with_ideal_angles(entries[:3000]):
        if isinstance(entry.given, Reading):
            assert_allclose(entry.given.z, entry.given.sensor.h(entry.truth), rtol=0, atol=0)
            assert_allclose(entry.given.sensor.linearize(entry.truth)[2], np.eye(2) * 1e-12)


def test_a_log_is_read_with_the_derivatives_that_are_asked_for(entries):
    signs = {
        reading: {
            e.given.sensor.elevation_sign for e in as_read(entries[:3000], reading) if isinstance(e.given, Reading)
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
            assert_allclose(line(kept.drawn["fig4-paths"].axes[0], "estimate").get_xdata(), first.pose[:, 0])
