"""A filter from the cells of a notebook."""

import pickle
import re
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from around import CLASS as AROUND

import ekfsim
from ekfsim.errors import UsageError
from ekfsim.files.template import template
from ekfsim.student.fault import FaultError
from ekfsim.student.own import loading
from ekfsim.study.block import run_block
from ekfsim.study.running.engines import Failed, do_packed
from ekfsim.version import VERSION

CELL = template("filter-complete")
CLASS = AROUND.replace("Mine", "MyEKF")
PLACE = "/anywhere/ipykernel_4711/{}.py"


@pytest.fixture(autouse=True)
def brought(monkeypatch):
    """Nothing that one test brings is known to the next."""
    known = {}  # first where it is imported, which its import must find as it was
    monkeypatch.setattr("ekfsim.student.own.bring.BROUGHT", known)
    monkeypatch.setattr(loading, "BROUGHT", known)
    return known


def cell(text, names=None, number=1):
    """What a cell of a notebook defines, in the kernel's names."""
    names = {} if names is None else names
    exec(compile(text, PLACE.format(number), "exec"), names)
    return names


def told(scene):
    return [(step.posterior.mean, step.posterior.covariance) for step in ekfsim.play(scene)]


def check_is_the_ekf(scene, name):
    for (x, P), (ours, of_ours) in zip(told(replace(scene, filter=name)), told(scene), strict=True):
        np.testing.assert_allclose(x, ours, atol=1e-12)
        np.testing.assert_allclose(P, of_ours, atol=1e-12)


@pytest.mark.parametrize("scene", ["tour", "proof-no-noise"])
def test_functions_a_class_a_module_and_a_file_are_brought(tmp_path, scene):
    scene, names = ekfsim.load_scene(scene), cell(CELL + CLASS)
    check_is_the_ekf(scene, ekfsim.bring(names["predict"], names["update"], name="two"))
    assert ekfsim.bring(names["MyEKF"]) == "MyEKF"
    check_is_the_ekf(scene, "MyEKF")
    module = ModuleType("package.mine")
    exec(CELL, vars(module))
    assert ekfsim.bring(module) == "mine"
    check_is_the_ekf(scene, "mine")
    (tmp_path / "file.py").write_text(CELL)
    assert ekfsim.bring(tmp_path / "file.py") == str(tmp_path / "file.py")
    check_is_the_ekf(scene, str(tmp_path / "file.py"))


def test_the_page_on_filters_of_ones_own_does_what_it_says():
    """Its functions are the EKF, in the cell that it shows."""
    page = Path(__file__).parents[3] / "docs/course/own-filter.md"
    functions, notebook = re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    names = cell(notebook, cell(functions), 2)
    assert names["mine"] == "mine"
    check_is_the_ekf(ekfsim.load_scene("tour"), "mine")
    np.testing.assert_allclose(
        names["steps"][-1].posterior.mean, told(ekfsim.load_scene("tour"))[-1][0], atol=1e-12
    )


def test_the_two_halves_of_play_take_it():
    names, scene = cell(CELL), ekfsim.load_scene("square")
    scene = replace(scene, filter=ekfsim.bring(names["predict"], names["update"], name="mine"))
    filter, belief = ekfsim.filter_of(scene), ekfsim.first_belief(scene)
    steps = list(ekfsim.localize(ekfsim.simulate(scene), filter, belief))
    assert len(steps) == len(told(scene))
    assert "filter mine" in ekfsim.narrate(next(iter(ekfsim.Playback(steps))), scene)


def test_a_cell_that_is_run_again_replaces_it():
    names, scene = cell(CELL), replace(ekfsim.load_scene("square"), filter="mine")
    ekfsim.bring(names["predict"], names["update"], name="mine")
    before = told(scene)[-1]
    cell("def update(x, P, z, sensor):\n    return x, P\n", names, 2)
    np.testing.assert_array_equal(told(scene)[-1][1], before[1])  # not before it is brought again
    ekfsim.bring(names["predict"], names["update"], name="mine")
    assert told(scene)[-1][1].trace() > before[1].trace()


def test_a_fault_names_the_cell_and_its_line():
    names = cell(CELL.replace("    return motion.f", "    x[7]\n    return motion.f"))
    scene = replace(
        ekfsim.load_scene("square"),
        filter=ekfsim.bring(names["predict"], names["update"], name="mine"),
    )
    with pytest.raises(FaultError) as fault:
        told(scene)
    line = CELL[: CELL.index("    return motion.f")].count("\n") + 1
    assert str(fault.value).startswith(f"cell:{line}: step 1 (move 3 m, 90°): IndexError: ")


@pytest.mark.parametrize(
    ("own", "name", "words"),
    [
        ("pu", "ekf", "bring: there is a filter 'ekf' already; choose another name"),
        (
            "pu",
            "",
            "bring: '' is no name of letters, digits and -; write bring(predict, update, "
            'name="mine")',
        ),
        (
            "pu",
            "a.py",
            "bring: 'a.py' is no name of letters, digits and -; write bring(predict, update, "
            'name="mine")',
        ),
        ("pup", "mine", "bring was given 3 things; write predict(x, P, u, motion) and"),
        ("p", "mine", "mine: is no class; write predict(x, P, u, motion) and"),
        (["mine"], "", "bring: 'mine' is no place of a filter; write FILE.py or FILE.py:Name"),
    ],
)
def test_what_is_no_filter_is_told(brought, own, name, words):
    names = cell(CELL)
    functions = {"p": names["predict"], "u": names["update"]}
    with pytest.raises(UsageError) as refused:
        ekfsim.bring(*(functions.get(one, one) for one in own), name=name)
    assert str(refused.value).startswith(words)
    assert brought == {}


def test_a_worker_does_not_know_it(brought):
    names = cell(CELL)
    scene = replace(
        ekfsim.load_scene("square"),
        filter=ekfsim.bring(names["predict"], names["update"], name="mine"),
    )
    assert run_block(scene, 0, 3).runs == 3
    block = pickle.dumps(partial(run_block, scene))
    brought.clear()  # as in another process
    assert do_packed(block, 0, 3, VERSION) == Failed(
        "a worker cannot do this: mine: there is no such filter here; one that was brought is "
        "known to its own process alone: write it to a file, and name that"
    )
