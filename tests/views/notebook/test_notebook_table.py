"""The table holds what `run --csv` writes, to the last digit, with pandas and without."""

import csv
import io
import sys

import numpy as np
import pytest

import ekfsim
from ekfsim.files.results.trajectories import Table
from ekfsim.views.notebook import table as home

SCENES = ("tour", "diverge-01-wrong-wall", "pioneer", "gnss")


def written(scene, steps):
    """The CSV of the steps: its cells by column."""
    file = io.StringIO()
    sink = Table(file, scene, 0.954)
    for step in steps:
        sink.write(step)
    head, *rows = csv.reader(io.StringIO(file.getvalue()))
    return dict(zip(head, zip(*rows, strict=True), strict=True))


@pytest.fixture
def without_pandas(monkeypatch):
    monkeypatch.setattr(home, "find_spec", lambda name: None)
    monkeypatch.setitem(sys.modules, "pandas", None)


def same(value, cell):
    if isinstance(value, str):
        return value == cell
    return cell == "" if np.isnan(value) else value == float(cell)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("bare", [False, True])
def test_every_cell_is_that_of_the_csv(name, bare, request):
    if bare:
        request.getfixturevalue("without_pandas")
    scene = ekfsim.load_scene(name)
    steps = [step for step, _ in zip(ekfsim.play(scene), range(400), strict=False)]
    table, told = ekfsim.table(steps), written(scene, steps)
    assert list(table) == list(told)[: len(list(table))]
    assert set(told) - set(table) == {"ekfsim", "world", "commands", "filter", "gate", "guard",
                                      "seed", "run", "confidence", "format"}  # fmt: skip
    for column in table:
        assert len(table[column]) == len(steps)
        assert all(map(same, table[column], told[column])), column


def test_it_is_a_data_frame_where_pandas_is():
    pandas = pytest.importorskip("pandas")
    table = ekfsim.table(ekfsim.play(ekfsim.load_scene("square")))
    assert isinstance(table, pandas.DataFrame)
    assert table["index"].dtype == np.int64
    assert set(table.query("type == 'sense'")["nis"] >= 0) == {True}


def test_without_pandas_it_shows_its_ends(without_pandas):
    scene = ekfsim.load_scene("tour")
    table = ekfsim.table(ekfsim.play(scene))
    lines = repr(table).splitlines()
    assert (lines[0].split()[:3], lines[-1]) == (
        ["index", "type", "x"],
        f"31 rows × {len(table)} columns",
    )
    assert [line.split()[0] for line in lines[1:-1]] == [*"01234", "…", *map(str, range(26, 31))]
    assert table._repr_html_().count("<tr>") == 12


def test_what_is_told_of_the_ellipse_follows_the_confidence():
    steps = [*ekfsim.play(ekfsim.load_scene("square"))]
    wide, narrow = (ekfsim.table(steps, p)["ellipse_major"].iloc[-1] for p in (0.99, 0.5))
    assert wide / narrow == pytest.approx(np.sqrt(np.log(0.01) / np.log(0.5)))


def test_no_steps_make_no_rows():
    assert len(ekfsim.table([])) == 0


def test_steps_of_many_runs_make_no_table():
    steps = ekfsim.play(ekfsim.load_scene("square"), np.arange(3))
    with pytest.raises(ekfsim.UsageError, match="a table is of one run"):
        ekfsim.table(steps)
