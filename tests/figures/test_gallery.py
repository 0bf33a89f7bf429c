"""The table of the inputs that make the filter fail."""

import csv
import re
from dataclasses import replace
from pathlib import Path

import pytest

from ekfsim.diagnostics.verdict import Evidence
from ekfsim.figures.album import Album
from ekfsim.figures.classroom import gallery
from ekfsim.figures.classroom.proofs import shipped
from ekfsim.files.packaged import packaged
from ekfsim.filters.belief import Refused
from ekfsim.localization import play

SCENARIOS = Path(__file__).resolve().parents[2] / "docs" / "judging" / "scenarios.md"
DIVERGE = [name for name in packaged("commands") if name.startswith("diverge-")]
RUNS = 40


def alone(name, seed, **cure):
    """How many runs are lost, and how many readings are left out, each run played by itself."""
    lost = left_out = 0
    for run in range(RUNS):
        evidence = Evidence()
        for step in play(replace(shipped(name), seed=seed, run=run, **cure)):
            evidence.add(step)
            refused = None if step.correction is None else Refused(int(step.correction.refused))
            left_out += refused in (Refused.GATE, Refused.GUARD)
        lost += evidence.lost_from is not None
    return lost, left_out / RUNS


@pytest.mark.parametrize("name", ["diverge-08-grazing", "diverge-12-close-to-the-wall"])
def test_a_row_counts_what_each_run_alone_says(monkeypatch, name):
    monkeypatch.setattr(gallery, "RUNS", RUNS)
    monkeypatch.setattr(gallery, "RUNS_UNDER_A_CURE", RUNS)
    row = gallery.row(name, 5)
    assert len(row) == len(gallery.HEAD)
    huber = gallery.HEAD.index("lost, huber")
    for column, cure in (
        (1, {}), (6, {"gate": 0.99}), (8, {"guard": "skip"}), (huber, {"filter": "huber"}),
    ):  # fmt: skip
        lost, left_out = alone(name, 5, **cure)
        assert float(row[column].split()[0]) == pytest.approx(100 * lost / RUNS, abs=0.06)
        if column in (6, 8):
            assert float(row[column + 1].split(" of ")[0]) == pytest.approx(left_out, rel=1e-2)


def test_all_inputs_are_run_with_one_seed_and_stand_in_the_readme(monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr(
        gallery,
        "row",
        lambda name, seed: asked.append((name, seed)) or [name, *["-"] * (len(gallery.HEAD) - 1)],
    )
    gallery.draw_gallery(replace(shipped(DIVERGE[0]), seed=2), Album("gallery", "", tmp_path))
    assert asked == [(name, 2) for name in DIVERGE]
    with (tmp_path / "gallery.csv").open(encoding="utf-8") as file:
        found = list(csv.DictReader(file))
    assert [line["input"] for line in found] == DIVERGE
    assert all("seed 2, runs 0 to 999" in line["made by"] for line in found)
    told = re.findall(
        r"^\| (\S+) \|.*\| ([\d.]+) \[([\d.]+), ([\d.]+)\] \|",
        SCENARIOS.read_text(encoding="utf-8"),
        re.M,
    )
    assert [f"diverge-{name}" for name, *_ in told] == DIVERGE
    assert all(float(low) <= float(share) <= float(high) for _, share, low, high in told)
