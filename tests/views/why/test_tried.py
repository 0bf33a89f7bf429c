"""The table of changes, on paper and as CSV."""

import csv
import io
import math

import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.views.why.tried import HEAD, table, write_csv
from ekfsim.why import Change, Explanation, Tried

SCENE = load_scene("square")
CURE = Change("reading", '=the beam, "13"', "left out", 13)
CHANGES = [
    Tried(CURE, True, 2.345678912, None, "over-confident"),
    Tried(Change("fault", "the bias of the laser", "0.1 m"), False, math.nan, 7, "lost"),
    *(
        Tried(Change("move", f"the move of step {n}", "made exact", n), False, 10.0 * n, n, "lost")
        for n in range(1, 6)
    ),
]
FOUND = Explanation(SCENE, "lost", 5, tuple(CHANGES), cure=(CURE,), replays=7, budget=400)


def test_every_change_comes_back_from_the_file():
    file = io.StringIO()
    write_csv(file, FOUND)
    rows = list(csv.DictReader(io.StringIO(file.getvalue())))
    assert list(rows[0])[: len(HEAD)] == list(HEAD)
    assert len(rows) == len(CHANGES)
    for row, one in zip(rows, CHANGES, strict=True):
        assert row["kind"] == one.change.kind
        assert row["name"].removeprefix("'") == one.change.name
        assert row["told"] == one.change.told
        assert (int(row["step"]) if row["step"] else None) == one.change.step
        assert bool(int(row["cures"])) == one.cures
        assert bool(int(row["in_cure"])) == (one.change == CURE)
        assert row["outcome"] == one.outcome
        nees = float(row["nees_end"] or math.nan)
        assert nees == pytest.approx(one.nees_end, rel=1e-8, nan_ok=True)
        assert (int(row["lost_from"]) if row["lost_from"] else None) == one.lost_from
        assert (row["seed"], row["commands"]) == (str(SCENE.seed), SCENE.commands_source)


def test_a_spreadsheet_calculates_nothing():
    file = io.StringIO()
    write_csv(file, FOUND)
    assert "'=the beam" in file.getvalue()


def test_what_was_put_right_gives_way_where_there_is_no_room_for_it():
    wide, narrow = (table(FOUND, width) for width in (70, 60))
    assert any("the bias of the laser (0.1 m)" in line for line in wide)
    assert any("the bias of the laser  " in line for line in narrow)
    assert max(map(len, narrow)) <= 60


def test_many_of_a_kind_that_do_not_cure_share_a_row():
    lines = table(FOUND)
    assert len(lines) == 4  # head, the cure, the fault, the moves
    assert lines[1].startswith("cures  =the beam")
    assert "5 moves, each made exact" in lines[3]
    assert "10 … 50" in lines[3]
    assert "impossible" in lines[2]
