"""`new filter.py`: two functions to start from, open or complete."""

import io
import tokenize
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from program import ekfsim

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene
from ekfsim.files.template import template
from ekfsim.localization import play

CLASSROOM = [
    name
    for name, path in packaged("commands").items()
    if "\ncommands:" in path.read_text("utf-8") and name != "unknown-start"
]
OPEN = {"predict": ["6", "1", "4", "7"], "update": ["8 and 9", "11", "10", "12"]}


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def functions_of(text):
    names = {}
    exec(text, names)
    return names


def test_a_filter_to_start_from_says_which_equation_is_open():
    told = ekfsim("new", "filter.py")
    assert (told.status, told.err) == (0, "")
    assert told.out == (
        "filter.py: a filter file to start from; ekfsim play tour --filter filter.py plays it\n"
    )
    found = ekfsim("check", "filter.py").out.split()
    assert " ".join(word for word in found if not word.strip(",").isdigit()) == (
        "filter.py: ok: predict in line (still open), update in line (still open)"
    )
    lines = Path("filter.py").read_text().splitlines(keepends=True)
    for function, equations in OPEN.items():
        for number in equations:
            with pytest.raises(NotImplementedError, match=rf"^eqs?\.? {number} (is|are) open: "):
                functions_of("".join(lines))[function](np.zeros(3), np.zeros((3, 3)), None, None)
            done = next(
                i for i, line in enumerate(lines) if f" {number} " in line and "Not" in line
            )
            lines[done] = ""  # as if its equation stood there
        x, P = functions_of("".join(lines))[function](np.zeros(3), np.zeros((3, 3)), None, None)
        assert (x.shape, P.shape) == ((3,), (3, 3))


def test_the_complete_one_has_few_lines_and_needs_no_ekfsim():
    assert ekfsim("new", "mine.py", "--complete").status == 0
    text = Path("mine.py").read_text()
    assert "import ekfsim" not in text
    words = [
        token
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type in (tokenize.NAME, tokenize.OP, tokenize.NUMBER)
    ]
    assert len({token.start[0] for token in words}) <= 12


@pytest.mark.parametrize("name", CLASSROOM)
def test_the_complete_one_is_the_ekf_in_every_classroom_scene(place, name):
    """To 1e-9 standard deviations of at least 1e-6 (m, rad): P is singular on the first moves."""
    (place / "mine.py").write_text(template("filter-complete"))
    scene = load_scene(name)
    mine = play(replace(scene, filter=str(place / "mine.py")))
    for step, ours in zip(mine, play(replace(scene, filter="ekf")), strict=True):
        (x, P), (x0, P0) = step.posterior, ours.posterior
        σ = np.maximum(np.sqrt(np.maximum(np.diag(P0), 0)), 1e-6)
        off = x - x0
        off[2] = np.arctan2(np.sin(off[2]), np.cos(off[2]))
        assert np.abs(off / σ).max() < 1e-9
        assert np.abs((P - P0) / np.outer(σ, σ)).max() < 1e-9


def test_a_filter_overwrites_nothing_and_its_kind_may_be_told():
    Path("mine.py").write_text("x = 1\n")
    assert ekfsim("new", "mine.py").status == 2
    assert Path("mine.py").read_text() == "x = 1\n"
    assert ekfsim("new", "mine.py", "--force").status == 0
    told = ekfsim("new", "sub/my-ekf", "--kind", "filter")
    assert told.status == 0
    assert told.out.endswith("it is played under a name that ends in .py\n")
    assert Path("sub/my-ekf").read_text() == Path("mine.py").read_text()


@pytest.mark.parametrize("args", [["world.yaml"], ["mine.py", "--kind", "commands"]])
def test_only_a_filter_can_be_complete(args):
    told = ekfsim("new", *args, "--complete")
    assert (told.status, told.out) == (2, "")
    assert told.err == (
        f"ekfsim: {args[0]}: --complete is of a filter; leave it out, or say --kind filter\n"
    )
    assert not Path(args[0]).exists()
