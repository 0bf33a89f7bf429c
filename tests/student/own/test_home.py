"""What a student's code may import, and what it is handed."""

import sys
import types
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from files import CLASS, FUNCTIONS

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.files.scenes.settings import filters_in
from ekfsim.localization import play
from ekfsim.student.fault import FaultError
from ekfsim.student.own import loading

TOUR = load_scene("tour")


def last(place):
    """What a run under this filter ends with."""
    *_, step = play(replace(TOUR, filter=str(place)))
    return step.posterior


def test_helpers_of_one_name_in_two_folders_do_not_mix(tmp_path):
    for folder, shift in (("a", 1), ("b", 2)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "helper.py").write_text(f"SHIFT = {shift}\n")
        (tmp_path / folder / "mine.py").write_text(
            "def predict(x, P, u, motion):\n    import helper\n    return [helper.SHIFT, 0, 0], P\n"
            "def update(x, P, z, sensor):\n    return x, P\n"
        )
    path = list(sys.path)
    ends = [last(tmp_path / folder / "mine.py").mean[0] for folder in ("a", "b", "a")]
    assert ends == [1, 2, 1]
    assert "helper" not in sys.modules
    assert sys.path == path
    assert not list(tmp_path.rglob("__pycache__"))


def test_a_changed_helper_is_read_anew(tmp_path):
    (tmp_path / "mine.py").write_text(
        "from helper import SHIFT\ndef predict(x, P, u, motion):\n    return [SHIFT, 0, 0], P\n"
        "def update(x, P, z, sensor):\n    return x, P\n"
    )
    for shift in (1, 2):
        (tmp_path / "helper.py").write_text(f"SHIFT = {shift}\n")
        assert last(tmp_path / "mine.py").mean[0] == shift


def test_a_file_that_is_called_as_a_module_of_pythons_disturbs_nobody(tmp_path, monkeypatch):
    monkeypatch.delitem(sys.modules, "statistics", raising=False)
    (tmp_path / "statistics.py").write_text("mine = True\n")
    (tmp_path / "numpy.py").write_text(
        "import statistics\nassert statistics.mine\n"
        "def predict(x, P, u, motion):\n    return motion.f(x, u), P\n"
        "def update(x, P, z, sensor):\n    return x, P\n"
    )
    last(tmp_path / "numpy.py")
    import statistics

    assert statistics.mean([1, 3]) == 2


def test_whatever_signs_a_file_begins_with(tmp_path):
    """A byte order mark, and lines that end as on Windows."""
    wrong = FUNCTIONS.replace("    return motion.f(x, u)", "    return 'σ', motion.f(x, u)")
    (tmp_path / "mine.py").write_bytes(b"\xef\xbb\xbf" + wrong.replace("\n", "\r\n").encode())
    with pytest.raises(FaultError, match=r"mine\.py:5: step 2 .* predict returns 3 values"):
        last(tmp_path / "mine.py")


def test_the_folder_that_we_are_in_stays_ours(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there").mkdir()
    (tmp_path / "mine.py").write_text(
        FUNCTIONS.replace("    H = ", "    import os; os.chdir('/')\n    H = ")
    )
    last(tmp_path / "mine.py")
    assert Path.cwd() == tmp_path


def test_a_class_as_dataclasses_make_it(tmp_path):
    (tmp_path / "mine.py").write_text(
        "from __future__ import annotations\nfrom dataclasses import dataclass\n"
        + CLASS.replace(
            "class Mine:\n    def __init__(self, x, P):\n        self.x, self.P = x, P\n",
            "@dataclass\nclass Mine:\n    x: np.ndarray\n    P: np.ndarray\n",
        )
    )
    assert np.allclose(last(tmp_path / "mine.py").mean, last("ekf").mean, rtol=0, atol=1e-12)


def test_a_function_of_a_helper_is_told_at_its_own_line(tmp_path):
    (tmp_path / "helper.py").write_text("\n\ndef update(x, P, z, sensor):\n    return x\n")
    (tmp_path / "mine.py").write_text(
        f"{FUNCTIONS[: FUNCTIONS.index('def update')]}\nfrom helper import update\n"
    )
    with pytest.raises(FaultError, match=r"/helper\.py:3: step 6 .* one array of shape"):
        last(tmp_path / "mine.py")


def test_what_is_handed_over_is_theirs_to_spoil(tmp_path):
    (tmp_path / "good.py").write_text(FUNCTIONS)
    spoilt = FUNCTIONS
    for line in ("    F, G =", "    H = "):
        what = "u, motion" if "F" in line else "z, sensor"
        spoil = (
            "    x0, P0, v = x.copy(), P.copy(), {0}.copy()\n    {1}\n"
            "    x[:], P[:], {0}[:] = 7, 7, 7\n    x, P, {0} = x0, P0, v\n"
        ).format(
            what[0],
            "motion.F(x, u)[:] = 7"
            if "F" in line
            else "sensor.H(x)[:] = 7; sensor.walls[:] = 7; sensor.R(x)[:] = 7",
        )
        spoilt = spoilt.replace(line, spoil + line)
    (tmp_path / "spoilt.py").write_text(spoilt)
    for good, bad in zip(last(tmp_path / "good.py"), last(tmp_path / "spoilt.py"), strict=True):
        assert np.array_equal(good, bad)


def test_a_sensor_and_a_motion_tell_their_numbers(tmp_path):
    (tmp_path / "mine.py").write_text(
        "seen = set()\n"
        "def predict(x, P, u, motion):\n"
        "    assert (motion.distance_ratio, motion.angle_ratio) == (0.05, 0.03), motion\n"
        "    assert motion.Q(u).shape == (3, 3) and u.shape == (2,)\n"
        "    return motion.f(list(x), list(u)), P\n"
        "def update(x, P, z, sensor):\n"
        "    assert sensor.range_ratio == 0.02 and sensor.walls.shape[1:] == (2, 2)\n"
        "    assert abs(sensor.residual([2.0], 0.5)[0] - 1.5) < 1e-15\n"
        "    assert abs(sensor.bearing) <= 6.3 and z.shape == (1,)\n"
        "    return x, P\n"
    )
    last(tmp_path / "mine.py")


def test_each_play_begins_an_object_anew(tmp_path):
    """Runs side by side have one each."""
    (tmp_path / "mine.py").write_text(CLASS)
    scene = replace(TOUR, filter=str(tmp_path / "mine.py"))
    *_, alone = play(scene)
    *_, again = play(scene)
    *_, many = play(scene, np.arange(3))
    assert np.array_equal(alone.posterior.mean, again.posterior.mean)
    assert np.allclose(many.posterior.mean[0], alone.posterior.mean, rtol=0, atol=1e-12)
    *_, second = play(replace(scene, run=1))
    assert np.allclose(many.posterior.mean[1], second.posterior.mean, rtol=0, atol=1e-12)
    assert not np.allclose(many.posterior.mean[0], many.posterior.mean[1], atol=1e-3)


def test_a_belief_that_is_overruled_is_set_in_the_object(tmp_path):
    """As where σ_xθ and σ_yθ are dropped after each step: the two functions are handed the same."""
    from ekfsim.filters.tuning import Tuning

    (tmp_path / "functions.py").write_text(FUNCTIONS)
    (tmp_path / "kind.py").write_text(CLASS)
    ends = []
    for name in ("functions.py", "kind.py"):
        scene = replace(TOUR, tuning=Tuning(cross_covariances="dropped"))
        *_, step = play(replace(scene, filter=str(tmp_path / name)))
        ends.append(step.posterior)
    assert np.array_equal(ends[0].mean, ends[1].mean)
    assert ends[0].covariance[0, 2] == 0
    assert not np.allclose(ends[0].mean, last(tmp_path / "kind.py").mean, rtol=0, atol=1e-6)


def test_a_whole_filter_takes_part(tmp_path):
    (tmp_path / "mine.py").write_text("import ekfsim\nclass Mine(ekfsim.EKF):\n    pass\n")
    for theirs, ours in zip(last(tmp_path / "mine.py"), last("ekf"), strict=True):
        assert np.array_equal(theirs, ours)


class Registered:
    """An entry point."""

    def __init__(self, name, value):
        self.name, self.value = name, value


@pytest.fixture
def registering(monkeypatch):
    """Lets packages register filters, and installs a module `lab` with two functions."""
    module = types.ModuleType("lab")
    exec(FUNCTIONS, module.__dict__)
    monkeypatch.setitem(sys.modules, "lab", module)

    def register(*points):
        def found(group, name=None):
            assert group == "ekfsim.filters"
            return [one for one in points if name in (None, one.name)]

        monkeypatch.setattr(loading, "entry_points", found)
        monkeypatch.setattr("importlib.metadata.entry_points", found)

    return register


def test_a_registered_filter_is_known_by_its_name(registering):
    registering(Registered("labs", "lab"), Registered("broken", "no_such_module:X"))
    assert filters_in("labs,ekf") == ("labs", "ekf")
    assert np.allclose(last("labs").mean, last("ekf").mean, rtol=0, atol=1e-12)
    with pytest.raises(UsageError, match=r"^no_such_module:X: there is no such module; it must"):
        filters_in("broken")
    with pytest.raises(UsageError, match=r"^--filter lab: there .* did you mean 'labs'"):
        filters_in("lab")


def test_built_in_names_win_and_two_of_one_name_are_told(registering):
    registering(Registered("ekf", "no:X"), Registered("m", "a:X"), Registered("m", "b:Y"))
    assert filters_in("ekf") == ("ekf",)
    last("ekf")
    with pytest.raises(UsageError) as raised:
        filters_in("m")
    assert str(raised.value) == "m: 2 packages register it; name one of them: a:X or b:Y"
