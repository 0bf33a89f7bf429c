"""Filters that installed packages register under the entry-point group `ekfsim.filters`."""

import csv
import sys
from pathlib import Path

import pytest
from around import CLASS
from jsonschema import Draft202012Validator
from program import ekfsim, lay_out

from ekfsim.files.template import template
from ekfsim.files.yaml import schema
from ekfsim.filters.choice import registered
from ekfsim.views.study import folder as study_folder

METADATA = "Metadata-Version: 2.1\nName: {}\nVersion: 1.0\n"


def install(folder, package, entries, text):
    """A package as pip would lay it into a folder."""
    (folder / package).mkdir(parents=True)
    (folder / package / "__init__.py").write_text("")
    (folder / package / "filters.py").write_text(text)
    about = folder / f"{package}-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(METADATA.format(package))
    told = "".join(f"{name} = {package}.{place}\n" for name, place in entries.items())
    (about / "entry_points.txt").write_text(f"[ekfsim.filters]\n{told}")


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    entries = {
        "square-root": "filters:Mine",
        "ekf": "filters:nothing",
        "lost": "nowhere:Mine",
        "broken": "broken:Mine",
    }
    install(tmp_path / "site", "some_filters", entries, template("filter-complete") + CLASS)
    (tmp_path / "site/some_filters/broken.py").write_text("1 / 0\n")
    monkeypatch.syspath_prepend(tmp_path / "site")
    monkeypatch.chdir(lay_out(tmp_path))
    schema.json_schema.cache_clear()
    yield tmp_path
    schema.json_schema.cache_clear()
    for name in [name for name in sys.modules if name.startswith("some_filters")]:
        del sys.modules[name]


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_a_registered_name_is_as_good_as_a_built_in_one(place):
    assert registered() == ["broken", "lost", "square-root"]  # built-in names win
    ours, theirs = (
        ekfsim("run", "short.yaml", "--filter", name) for name in ("ekf", "square-root")
    )
    assert (theirs.status, theirs.err) == (0, "")
    assert theirs.out.splitlines()[-1] == ours.out.splitlines()[-1]  # the verdict and its numbers
    (place / "own.yaml").write_text(f"filter: square-root\n{Path('short.yaml').read_text()}")
    assert ekfsim("check", "own.yaml").out == "own.yaml: ok\n"
    assert "square-root" in ekfsim("run", "own.yaml").out


def test_a_study_with_workers_knows_it(place, monkeypatch):
    monkeypatch.setattr(study_folder, "draw_study", lambda *drawn: None)  # pictures take a second
    (place / "s.yaml").write_text("study: short.yaml\nruns: 30\nfilters: [square-root, ekf]\n")
    told = ekfsim("study", "s.yaml", "--workers", 2, "-o", "out")
    assert (told.status, told.err) == (0, "")
    theirs, ours = rows("out/summary.csv")
    assert (theirs.pop("filter"), ours.pop("filter")) == ("square-root", "ekf")
    for name in ("position_rmse", "nis_mean", "above_95", "lost"):
        assert float(theirs[name]) == pytest.approx(float(ours[name]), rel=1e-5)
    assert "filters: ['square-root', ekf]" in (place / "out/study.yaml").read_text()


@pytest.mark.parametrize(
    ("name", "status", "line"),
    [
        (
            "lost",
            2,
            "ekfsim: some_filters.nowhere:Mine: there is no such module; it must be installed; a "
            "file is named FILE.py or FILE.py:Name",
        ),
        ("broken", 1, "some_filters/broken.py:1: ZeroDivisionError: division by zero"),
        (
            "square-rot",
            2,
            "ekfsim: --filter square-rot: there is no such filter; did you mean 'square-root'?",
        ),
    ],
)
def test_one_that_is_broken_is_told_and_the_others_are_not_touched(name, status, line):
    told = ekfsim("run", "short.yaml", "--filter", name)
    assert (told.status, told.out) == (status, "")
    assert told.err.removeprefix("site/") == f"{line}\n"
    assert ekfsim("run", "short.yaml", "--filter", "ekf", "-q").status == 0


def test_an_editor_knows_it():
    scene = {"world": "world.yaml", "commands": []}
    editor = Draft202012Validator(schema.json_schema("commands"))
    assert editor.is_valid({**scene, "filter": "square-root"})
    assert not editor.is_valid({**scene, "filter": "square-rot"})
