"""plot: one picture of a run's curves, whole or absent."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from program import ekfsim, lay_out, left_in

from ekfsim.diagnostics.verdict import LOST
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.localization import play
from ekfsim.views.curves.series import Series

PUT_IN = ["long.yaml", "short.yaml", "world.yaml"]
BEGINS = {".png": b"\x89PNG", ".pdf": b"%PDF"}
FAILING = """\
def predict(x, P, u, motion):
    return x, P

def update(x, P, z, sensor):
    return x, P / 0
"""


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


@pytest.mark.parametrize("kind", BEGINS)
def test_a_picture_of_each_kind(place, kind):
    drawn = ekfsim("plot", "short.yaml", "-o", f"new/run{kind}")
    assert (drawn.status, drawn.out, drawn.err) == (0, f"new/run{kind}: ekf over 3 steps\n", "")
    assert (place / f"new/run{kind}").read_bytes().startswith(BEGINS[kind])


def size(path):
    header = path.read_bytes()[16:24]
    return int.from_bytes(header[:4]), int.from_bytes(header[4:])


def test_a_picture_has_the_pixels_that_are_asked_for(place):
    assert ekfsim("plot", "short.yaml", "-o", "a.png", "--size", "1280x720").status == 0
    assert size(place / "a.png") == (1280, 720)
    assert ekfsim("plot", "short.yaml", "-o", "a.png", "--dpi", "50", "--force").status == 0
    assert size(place / "a.png") == (500, 447)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (("-o", "a.gif"), "a.gif: '.gif' is no kind of picture; name a .png, an .svg or a .pdf"),
        (("-o", "old.png"), "old.png: exists already; "),
        (("-o", "a.png", "--size", "250x250"), "there is no room for 5 panels in 2.5 by 2.5 inch"),
        (("-o", "a.png", "--size", "200x200", "--dpi", "1200"), "in 0.167 by 0.167 inches"),
        (
            ("-o", "a.png", "--size", "wide"),
            "'--size': 'wide' is no size; write pixels like 1280x720.",
        ),
        (("-o", "a.png", "--size", "9x9"), "'--size': 9x9 is no size of a picture; each side has "),
    ],
)
def test_what_cannot_be_is_told_and_nothing_is_written(place, options, why):
    (place / "old.png").write_text("older")
    refused = ekfsim("plot", "short.yaml", *options)
    assert (refused.status, refused.out) == (2, "")
    assert why in refused.err
    assert left_in(place) == sorted(["old.png", *PUT_IN])
    assert (place / "old.png").read_text() == "older"


def test_a_run_that_fails_leaves_nothing(place):
    (place / "mine.py").write_text(FAILING)
    failed = ekfsim("plot", "short.yaml", "--filter", "ekf,mine.py", "-o", "a.png")
    assert (failed.status, failed.out) == (1, "")
    assert failed.err == "mine.py:5: step 2 (sense 0°): P[0, 0] is inf\n"
    assert left_in(place) == sorted(["mine.py", *PUT_IN])


def test_filters_are_put_into_one_picture(place):
    drawn = ekfsim("plot", "short.yaml", "--filter", "ekf,ukf", "-o", "a.svg", "--run", 3)
    assert drawn.out == "a.svg: ekf, ukf over 3 steps\n"
    told = (place / "a.svg").read_text()
    assert "filter ekf,ukf" in told
    assert "run 3" in told


def test_that_a_log_holds_no_truth_is_said(place):
    assert ekfsim("record", "short.yaml", "-o", "log").status == 0
    (place / "read.yaml").write_text(
        "world: log/world.yaml\nrecording: {format: classroom, path: log}\n"
    )
    drawn = ekfsim("plot", "read.yaml", "-o", "a.png")
    assert (drawn.status, drawn.out) == (0, "a.png: ekf over 2 steps\n")
    assert drawn.err == "ekfsim: no truth is known: innovations and NIS alone\n"
    header, move = (place / "log/entries.csv").read_text().splitlines()[:2]
    (place / "log/entries.csv").write_text(f"{header}\n{move}\n")
    refused = ekfsim("plot", "read.yaml", "-o", "b.png")
    told = "ekfsim: there is nothing to plot: no truth is known, and nothing was read\n"
    assert (refused.status, refused.err) == (2, told)


ROOT = Path(__file__).parents[2]
COMMANDS = ROOT / "commands"
PAGE = (ROOT / "docs/pictures/plots.md").read_text(encoding="utf-8")


def run_of(name, **settings):
    return Series.of(play(replace(load_scene(f"{COMMANDS}/{name}.yaml"), **settings)))


def test_the_page_on_plots_tells_what_they_show():
    names = dict(re.findall(r"ekfsim plot (diverge-\S+) -o (\w+\.png)", PAGE))
    assert len(names) == 4
    wrong = run_of("diverge-01-wrong-wall")
    assert wrong.lost_from == 13
    assert wrong.nis[13] > quantile(LOST, 1)
    assert (np.abs(wrong.error[:13]) <= 2.5 * wrong.sigma[:13]).all()
    assert (np.abs(wrong.error[13]) > 4 * wrong.sigma[13]).all()
    assert run_of("diverge-01-wrong-wall", guard="skip").lost_from is None
    for filter in ("ukf", "pf"):
        assert run_of("diverge-01-wrong-wall", filter=filter).lost_from is None
    biased = run_of("diverge-04b-range-bias-one-sided")
    assert biased.lost_from == 15
    assert np.nanmax(biased.nis) < quantile(0.99, 1)
    cautious = run_of("diverge-02c-laser-distrusted")
    assert np.nanmax(cautious.nis) < 1
    still = run_of("diverge-10-standstill")
    assert (np.diff(still.sigma[:, 1]) < 0).all()
    assert abs(still.error[-1, 1]) > 2 * still.sigma[-1, 1]


def test_the_cell_on_the_page_runs():
    (cell,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(cell, {})


def test_a_strip_of_the_curves_beneath_each_picture(place):
    shown = "render", "short.yaml", "--filter", "ekf,ukf", "-o"
    assert ekfsim(*shown, "plain").status == ekfsim(*shown, "strip", "--strip").status == 0
    width, height = size(next((place / "plain").iterdir()))
    assert {size(file) for file in (place / "strip").iterdir()} == {(width, height + 240)}


def test_a_picture_of_one_step_has_it_too_and_both_share_the_size(place):
    one = "render", "short.yaml", "--step", "2", "--strip", "-o"
    assert ekfsim(*one, "a.png", "--size", "1000x800", "--dpi", "77").status == 0
    assert size(place / "a.png") == (1000, 800)
    refused = ekfsim(*one, "b.svg")
    assert (
        refused.err
        == "ekfsim: b.svg: --strip is made of pixels; name a .png, or see `ekfsim plot`\n"
    )
    refused = ekfsim(*one, "b.png", "--size", "1000x500")
    assert refused.status == 2
    assert refused.err.startswith(
        "ekfsim: --size 1000x500: --strip takes 240 rows of it, and leaves"
    )
    assert not (place / "b.png").exists()
