"""Document 003's figures: a filter that beats its fixes, and the recipe that spoils them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from kept import Kept

from ekfsim.errors import UsageError
from ekfsim.figures.gnss.document import draw_gnss
from ekfsim.figures.gnss.runs import Fixes
from ekfsim.figures.retold import retold
from ekfsim.figures.track import rmse
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.records import Control, Log, Reading
from ekfsim.systems.drives import Stretch, Stretches

LOG = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "mower_gnss"
LOGGED = pytest.mark.skipif(not LOG.is_dir(), reason="the recorded logs are not here")
RIGHT, RECIPE = (
    "the document's filter, written with dt (printed, corrected)",
    "the authors' recipe, a fix at every row (coded)",
)
NAMES = ["fig1-paths", "fig2-heading", "fig3-rms-x", "fig4-rms-y", "fig5-rms-phi", "fig6-recipe"]


def drawn(scene, folder):
    album = Kept("gnss", "test", folder)
    draw_gnss(scene, album)
    return album


def short(**changed):
    drive = Stretches((Stretch(2.5, 0.0, 3.0), Stretch(1.0, 1.0, 1.5)))
    return replace(load_scene("gnss"), drive=drive, **changed)


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    return drawn(short(), tmp_path_factory.mktemp("twin"))


@pytest.fixture(scope="module")
def logged(tmp_path_factory):
    return drawn(load_scene("gnss_log", log=LOG), tmp_path_factory.mktemp("log"))


def test_every_figure_has_its_units_and_its_caption(twin):
    assert list(twin.drawn) == NAMES
    assert [twin.drawn[f"fig{k}"].axes[0].get_ylabel() for k in ("2-heading", "3-rms-x",
    "5-rms-phi")] == [
        "heading φ (degrees)", "RMS error of x so far (m)", "RMS error of φ so far (rad)"
    ]  # fmt: skip
    assert all("printed figure" in twin.captions[name] for name in NAMES[:5])
    assert "no dt" in twin.captions["fig6-recipe"]


def test_figure_1_draws_truth_fixes_wheels_and_the_estimate(twin):
    labels = [line.get_label() for line in twin.drawn["fig1-paths"].axes[0].lines]
    assert labels == ["GNSS fixes", "truth", "wheels alone", "estimate: filter, with dt"]
    assert len(twin.line("fig1-paths", "GNSS").get_xdata()) == 45  # 10 Hz, 4.5 s
    assert len(twin.line("fig1-paths", "truth").get_xdata()) == 901
    low, high = twin.drawn["fig1-paths"].axes[1].get_xlim()
    assert high - low == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("name", "column"), [("fig3-rms-x", 0), ("fig4-rms-y", 1), ("fig5-rms-phi", 2)]
)
def test_the_rms_errors_are_those_of_all_instants_so_far(twin, name, column):
    # as it stood after the last update of each instant
    last = {step.entry.t: step for step in play(short())}
    errors = np.array([step.posterior.mean[[2, 3, 1]] - step.entry.truth for step in last.values()])
    wrapped = np.angle(np.exp(1j * errors[:, column])) if column == 2 else errors[:, column]
    line = twin.line(name, "filter, with dt")
    assert line.get_ydata()[-1] == pytest.approx(np.sqrt(np.mean(wrapped**2)))
    assert line.get_ydata()[300] == pytest.approx(np.sqrt(np.mean(wrapped[:301] ** 2)))
    assert twin.drawn[name].axes[0].get_yscale() == "log"
    others = {str(line.get_label()).partition(":")[0] for line in twin.drawn[name].axes[0].lines}
    assert others == {"wheels alone", "filter, with dt", "authors' recipe"} | (
        {"GNSS fixes"} if column < 2 else set()
    )


def test_the_twin_beats_its_fixes_and_the_recipe_spoils_them(twin):
    rows = twin.rows("errors")
    assert float(rows[RIGHT]["of raw GNSS"]) < 1 < 4 < float(rows[RECIPE]["of raw GNSS"])
    assert float(rows["raw GNSS, at its own instants"]["RMSE position (m)"]) == pytest.approx(
        0.15 * 2**0.5, rel=0.25
    )


def test_the_coded_reading_is_what_the_figures_show(tmp_path, monkeypatch):
    monkeypatch.setattr("ekfsim.figures.gnss.runs.RUNS", 2)
    coded = drawn(short(reading="coded"), tmp_path)
    assert coded.line("fig1-paths", "estimate").get_label() == "estimate: authors' recipe"
    assert coded.captions["fig1-paths"].startswith(
        "The estimate is farther from the truth than the fixes"
    )
    # the right filter is there all the same
    assert coded.rows("errors")[RIGHT]["of raw GNSS"].startswith("0.")


@LOGGED
def test_on_the_authors_data_the_filter_beats_the_fixes(logged):
    rows = logged.rows("errors")
    assert {name: float(row["RMSE position (m)"]) for name, row in rows.items()} == {
        "raw GNSS, at its own instants": pytest.approx(0.1975, abs=1e-4),
        "wheels alone": pytest.approx(2.0100, abs=1e-4),
        RIGHT: pytest.approx(0.0846, abs=5e-4),
        RECIPE: pytest.approx(1.8742, abs=1e-4),
        "the authors' recipe, at the recorded fixes alone": pytest.approx(17.4, abs=0.1),
    }
    assert "9.5 times that of the raw fixes" in logged.captions["fig6-recipe"]
    assert (
        "of 0.401 rad, the recipe 1.87 m and 0.757 rad: its heading is worse"
        in logged.captions["fig6-recipe"]
    )
    assert float(rows["wheels alone"]["RMSE φ (rad)"]) == pytest.approx(0.4006, abs=1e-4)


@LOGGED
def test_a_log_is_retold_as_its_reader_reads_it():
    for one, other in (("corrected", "coded"), ("coded", "printed")):
        told = retold(load_scene("gnss_log", log=LOG, reading=one), other)
        read = load_scene("gnss_log", log=LOG, reading=other)
        assert told.reading == read.reading
        assert np.array_equal(told.log.first.covariance, read.log.first.covariance)
        for a, b in zip(told.log.entries[:200], read.log.entries[:200], strict=True):
            match (a.given, b.given):
                case (Control(motion, u), Control(as_read, v)):
                    assert motion == as_read
                    assert np.array_equal(u, v)
                case (Reading(sensor, z, name), Reading(as_read, y, called)):
                    assert (sensor, name) == (as_read, called)
                    assert np.array_equal(z, y)
                case _:
                    assert a.given is b.given is None


def test_a_course_is_that_of_fixes_a_second_apart():
    t = np.arange(0, 3.05, 0.1)
    fixes = Fixes(t, np.column_stack([t, 2 * t]), np.zeros((31, 3)))
    times, courses = fixes.courses()
    assert times == pytest.approx(t[:21] + 0.5)
    assert courses == pytest.approx(np.full(21, np.arctan2(2, 1)))
    assert len(Fixes(t, np.zeros((31, 2)), np.zeros((31, 3))).courses()[0]) == 0  # it stood still
    assert rmse(np.hypot(*fixes.error.T)) == pytest.approx(np.sqrt(5 * np.mean(t**2)))


def test_what_cannot_be_drawn_is_told(tmp_path):
    entries = [replace(step.entry, truth=None) for step in play(short())]
    blind = replace(
        short(),
        drive=None,
        log=Log(tuple(entries), next(play(short())).posterior),
        log_source="lawn",
    )
    album = drawn(blind, tmp_path)
    assert list(album.drawn) == NAMES[:2]
    assert "this log has none" in album.pages[-1]
    deaf = tuple(entry for entry in entries if not isinstance(entry.given, Reading))
    with pytest.raises(
        UsageError, match="lawn: it holds no GNSS fix, and so there is nothing to draw"
    ):
        drawn(replace(blind, log=Log(deaf, blind.log.first)), tmp_path)


def test_the_twins_lesson_is_of_twenty_runs(twin):
    rows = twin.rows("errors-over-runs")
    right, recipe = (
        numbers(row["of raw GNSS"]) for name, row in rows.items() if name.startswith("the ")
    )
    assert right[2] < 1 < 4 < recipe[1]  # the worst of the one, the best of the other
    assert right[1] <= right[0] <= right[2]
    assert recipe[1] < recipe[2]  # not one run twenty times over


def numbers(cell):
    """The mean, the least and the most: 0.1 (0.05 to 0.2)"""
    return [float(word.strip("()")) for word in cell.replace("to", "").split()]
