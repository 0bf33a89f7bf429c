"""mutants: which known mistakes an input exposes."""

import csv
from pathlib import Path

import pytest
from program import ekfsim, left_in

from ekfsim.student.mistakes.known import KNOWN

NO_BEAM = "world: room\ncommands:\n  - move: {distance: 1, angle: 90}\n"


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.yaml").write_text(NO_BEAM)
    return tmp_path


def rows(told):
    """The rows of the table, by the name of the mistake."""
    names = {mistake.name for mistake in KNOWN}
    lines = (line.split() for line in told.out.splitlines())
    return {line[0]: line[1:] for line in lines if line and line[0] in names}


def test_one_input_is_told_with_the_first_wrong_number_of_each_mistake(place):
    told = ekfsim("mutants", "mine.yaml")
    assert (told.status, told.err) == (0, "")
    assert told.out.startswith("mine.yaml: exposes ")
    shown = rows(told)
    assert shown["turn-before-move"][:6] == ["step", "1", "(move", "1", "m,", "90°)"]
    assert shown["turn-before-move"][-1] == "1000"
    assert "innovation-sign" not in shown
    assert "  innovation-sign: your " in told.out.partition("Not exposed:")[2]
    assert "Cannot be made here: no-process-noise, " in told.out


def test_several_make_a_matrix(place):
    told = ekfsim("mutants", "mine.yaml", "tour", "proof-corner")
    assert (told.status, told.err) == (0, "")
    one, two, three, together = told.out.splitlines()[:4]
    assert one.startswith("1  mine.yaml: exposes ")
    assert two.startswith("2  tour: exposes ")
    assert three.startswith("3  proof-corner: exposes ")
    assert together.startswith("together: exposes ")
    shown = rows(told)
    assert shown["turn-before-move"] == ["1", "4", "·"]
    assert shown["innovation-sign"] == ["·", "6", "·"]
    assert shown["no-process-noise"] == ["-", "-", "-"]


def test_a_table_has_a_row_for_each_input_and_mistake(place):
    assert ekfsim("mutants", "mine.yaml", "proof-corner", "--csv", "out/table.csv").status == 0
    with Path("out/table.csv").open(newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert [row["mistake"] for row in table] == 2 * [mistake.name for mistake in KNOWN]
    first = table[0]
    assert (first["commands"], first["exposed"], first["step"], first["entry"]) == (
        "mine.yaml", "1", "1", "y",
    )  # fmt: skip
    assert float(first["right"]) != float(first["theirs"])
    assert {row["format"] for row in table} == {"1"}
    again = ekfsim("mutants", "mine.yaml", "--csv", "out/table.csv")
    assert (again.status, again.out) == (2, "")
    assert "exists already" in again.err


def test_all_of_them_is_a_status(place):
    told = ekfsim("mutants", "mine.yaml", "--all")
    assert told.status == 1
    assert told.err.startswith("ekfsim: not exposed: ")
    assert "innovation-sign" in told.err
    assert "no-process-noise" not in told.err  # no robot of the classroom could


def test_statistics_stand_beside(place):
    told = ekfsim("mutants", "mine.yaml", "--runs", "10", "--csv", "table.csv")
    assert (told.status, told.err) == (0, "")
    assert "(no mistake)" in told.out
    assert "statistics alone say of" in told.out
    with Path("table.csv").open(newline="", encoding="utf-8") as file:
        assert {row["runs"] for row in csv.DictReader(file)} == {"10"}


def test_a_log_exposes_as_much_as_the_run_that_it_is_of_but_what_the_command_tells(place):
    ekfsim("record", "proof-every-mistake", "-o", "log")
    Path("log.yaml").write_text(
        "world: log/world.yaml\nrecording: {format: classroom, path: log}\n"
    )
    told, simulated = ekfsim("mutants", "log.yaml"), ekfsim("mutants", "proof-every-mistake")
    assert (told.status, told.err) == (0, "")
    assert rows(simulated).keys() - rows(told).keys() == {"command-for-odometry", "command-in-P_u"}
    again = ekfsim("mutants", "log.yaml", "--runs", "5")
    assert (again.status, again.err) == (
        2, "ekfsim: --runs: log.yaml is a recording, which is one run\n",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("args", "line"),
    [
        (["tuor"], "did you mean 'tour'?"),
        (["tour", "square", "--runs", "9"], "--runs: name one COMMANDS"),
        ([], "Missing argument 'COMMANDS...'"),
    ],
)
def test_wrong_usage(place, args, line):
    told = ekfsim("mutants", *args)
    assert (told.status, told.out) == (2, "")
    assert line in told.err
    assert left_in(place) == ["mine.yaml"]
