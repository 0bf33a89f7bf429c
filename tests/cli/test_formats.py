"""What programs read says which format it has."""

import csv
import json
from pathlib import Path

import pytest
from program import ekfsim, lay_out

RUNS = "--runs", 64


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))


def formats_of(table):
    """What stands in the last column, under its name, in every row."""
    with Path(table).open(newline="") as file:
        header, *rows = csv.reader(file)
    assert rows
    return header[-1], {row[-1] for row in rows}


def test_trace_summary_and_table_of_a_run():
    results = ("--trace", "t.jsonl", "--csv", "t.csv", "--summary", "s.json")
    assert ekfsim("run", "short.yaml", "-q", *results).status == 0
    assert json.loads(Path("t.jsonl").read_text().splitlines()[0])["format"] == 1
    assert next(iter(json.loads(Path("s.json").read_text()).items())) == ("format", 1)
    assert formats_of("t.csv") == ("format", {"1"})


def test_tables_of_a_study_and_of_a_comparison():
    assert ekfsim("study", "short.yaml", *RUNS, "--sweep", "gate=0.9,0.99", "-o", "s").status == 0
    assert ekfsim("compare", "short.yaml", "--b", "gate=0.9", *RUNS, "-o", "c").status == 0
    for table in ("s/summary.csv", "s/steps.csv", "c/compare.csv"):
        assert formats_of(table) == ("format", {"1"})


def test_the_table_of_what_inputs_expose():
    assert ekfsim("mutants", "short.yaml", "tour", "--csv", "m.csv").status == 0
    assert formats_of("m.csv") == ("format", {"1"})
