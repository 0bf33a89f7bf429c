"""`ekfsim why`, as it is typed."""

import csv

import pytest
from program import ekfsim


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_a_consistent_run_has_nothing_to_explain():
    said = ekfsim("why", "square", "--runs", "100")
    assert said.status == 0
    assert "Cause: nothing to explain" in said.out


def test_what_was_tried_is_written(tmp_path):
    said = ekfsim(
        *("why", "diverge-02c-laser-distrusted", "--runs", "100", "--csv", "tried.csv"),
        *("-o", "why.png"),
    )
    assert said.status == 0, said.err
    with (tmp_path / "tried.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    told = next(row for row in rows if row["name"] == "the told rangeSigmaRatio")
    assert (told["kind"], told["cures"], told["in_cure"]) == ("noise", "1", "1")
    assert told["told"] == "0.08 told, 0.02 true"
    assert (tmp_path / "why.png").read_bytes().startswith(b"\x89PNG")


def test_what_stands_is_not_replaced(tmp_path):
    (tmp_path / "why.png").write_text("mine")
    said = ekfsim("why", "square", "-o", "why.png")
    assert said.status == 2
    assert "exists already" in said.err
    assert (tmp_path / "why.png").read_text() == "mine"


def test_one_filter_is_asked():
    said = ekfsim("why", "square", "--filter", "ekf,ukf")
    assert said.status == 2
    assert said.err.strip() == "ekfsim: --filter: one filter is asked why; name one"


def test_bad_input_is_told_in_a_line():
    for words in (["nosuch"], ["square", "--runs", "-1"], ["square", "-o", "why.txt"]):
        said = ekfsim("why", *words)
        assert said.status == 2
        assert "Traceback" not in said.err
