"""A study of a recorded log: each cell is the run that `ekfsim run` makes of the same settings."""

import csv
import json
from pathlib import Path

import pytest
from program import ekfsim

import ekfsim as package

SHORT = "drive: [{v: 2.5, omega: 0, for: 3}, {v: 1.0, omega: 60, for: 2}]\n"
SWEEP = "sensors.gnss.sigma=0.05,0.2"


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")
    (folder / "short.yaml").write_text(SHORT)
    made = ekfsim(
        "record",
        f"{folder}/short.yaml",
        "--world",
        "gnss",
        "--format",
        "own",
        "-o",
        f"{folder}/log",
    )
    assert made.status == 0, made.err
    return folder / "log"


@pytest.fixture
def studied(log, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return ekfsim(
        "study",
        "gnss_log",
        "--log",
        str(log),
        "--sweep",
        SWEEP,
        "--filter",
        "ekf,ukf",
        "-o",
        "out",
    )


def test_each_cell_is_one_run(studied, log):
    assert (studied.status, studied.err) == (0, "")
    rows = list(csv.DictReader(Path("out/summary.csv").read_text().splitlines()))
    assert [(row["sensors.gnss.sigma"], row["filter"]) for row in rows] == [
        ("0.05", "ekf"), ("0.05", "ukf"), ("0.2", "ekf"), ("0.2", "ukf"),
    ]  # fmt: skip
    ran = ekfsim(
        "run", "gnss_log", "--log", str(log), "--set", "sensors.gnss.sigma=0.05", "-q",
        "--summary", "one.json",
    )  # fmt: skip
    assert ran.status == 0
    one = json.loads(Path("one.json").read_text())
    assert float(rows[0]["nis_mean"]) == pytest.approx(one["nis"]["mean"], rel=1e-5)
    assert float(rows[0]["position_rmse"]) == pytest.approx(one["position"]["rmse"], rel=1e-5)
    assert rows[0]["innovations"] == one["whiteness"]["word"]
    assert rows[0]["verdict"] == one["verdict"]
    assert float(rows[0]["nis_mean"]) > 2 * float(rows[2]["nis_mean"])


def test_words_know_no_shares(studied, log):
    assert "one run, recorded in" in studied.out
    assert "% lost" not in studied.out
    assert "runs" not in studied.out.split("\n", 1)[1]
    assert Path("out/log.png").stat().st_size > 5000


def test_the_folder_repeats_it(studied):
    again = ekfsim("study", "out/study.yaml", "-o", "again")
    assert again.status == 0
    assert Path("again/summary.csv").read_bytes() == Path("out/summary.csv").read_bytes()
    assert ekfsim("study", "out/study.yaml", "-o", "again").status == 2  # it exists


@pytest.mark.parametrize("option", [["--runs", "5"], ["--workers", "2"], ["--expect"]])
def test_what_means_many_runs_is_refused(option, log):
    refused = ekfsim("study", "gnss_log", "--log", str(log), *option)
    assert refused.status == 2
    assert refused.err == (
        f"ekfsim: {option[0]}: a recording is one run, played once; leave this out\n"
    )


def test_in_a_notebook(log):
    scene = package.load_scene("gnss_log", log=log)
    found = package.study(scene, sweep={"sensors.gnss.sigma": [0.05, 0.2]})
    assert [one.summary.readings for one in found.results] == [
        found.results[0].summary.readings
    ] * 2
    assert "one run, recorded in" in repr(found)
    assert len(found.figure().axes) == 2
