"""A filter of one's own localizes as the EKF does."""

from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from files import CLASS, FUNCTIONS

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.systems import SYSTEMS


def apart(place, scene, most=200):
    """By how many σ, of at least 1e-6, a filter of one's own and the EKF differ at most."""
    size = 0.0
    for own, ekf in zip(
        islice(play(replace(scene, filter=str(place))), most),
        islice(play(replace(scene, filter="ekf")), most),
        strict=True,
    ):
        assert own.entry.index == ekf.entry.index
        (x, P), (x0, P0) = own.posterior, ekf.posterior
        σ = np.maximum(np.sqrt(np.diagonal(P0)), 1e-6)
        δ = x - x0
        for i in own.layout.headings:
            assert -np.pi < x[i] <= np.pi
            δ[i] = np.angle(np.exp(1j * δ[i]))
        size = max(size, np.abs(δ / σ).max(), np.abs((P - P0) / np.outer(σ, σ)).max())
        if own.correction is not None:
            assert own.correction.refused == ekf.correction.refused
            assert np.array_equal(np.isnan(own.correction.nis), np.isnan(ekf.correction.nis))
            assert np.allclose(own.correction.K, ekf.correction.K, rtol=1e-6, atol=1e-9)
    return size


@pytest.fixture
def mine(tmp_path):
    (tmp_path / "mine.py").write_text(FUNCTIONS)
    return tmp_path / "mine.py"


CLASSROOM = [
    name
    for name, path in packaged("commands").items()
    if "\ncommands:" in Path(path).read_text(encoding="utf-8") and name != "unknown-start"
]


@pytest.mark.parametrize("name", CLASSROOM)
def test_twelve_lines_equal_the_ekf_in_every_classroom_scene(mine, name):
    assert apart(mine, load_scene(name)) < 1e-9


@pytest.mark.parametrize("name", [*SYSTEMS, "pylon-lidar"])
def test_twelve_lines_equal_the_ekf_in_every_system(mine, name):
    assert apart(mine, load_scene(name)) < 1e-9


@pytest.mark.parametrize(
    ("name", "log"),
    [("gnss_log", "mower_gnss"), ("mrclam_log", "mrclam6_robot1"),
     ("ranges_log", "plaza2_mower_ranges"),
     ("pylon_log", "pylon/2020_2_26__17_21_59_filtered.csv")],
)  # fmt: skip
def test_twelve_lines_equal_the_ekf_on_recorded_logs(mine, name, log):
    path = Path(__file__).parents[3] / "../shared/data" / log
    if not path.exists():
        pytest.skip("the recorded log is not here")
    assert apart(mine, load_scene(name, log=path), 200) < 1e-9


@pytest.mark.parametrize("other", ["gate", "guard"])
def test_gate_and_guard_keep_readings_from_it(mine, other):
    """Refused by the numbers that are calculated at its own prior."""
    setting = {"gate": 0.9} if other == "gate" else {"guard": "skip"}
    scene = replace(load_scene("diverge-01-wrong-wall"), **setting)
    assert apart(mine, scene) < 1e-9
    refused = [step.correction.refused for step in play(replace(scene, filter=str(mine)))
               if step.correction is not None]  # fmt: skip
    assert {"gate": 4, "guard": 3}[other] in refused


def test_a_class_equals_the_ekf(tmp_path):
    (tmp_path / "mine.py").write_text(CLASS)
    assert apart(tmp_path / "mine.py", load_scene("tour")) < 1e-9


def test_a_heading_may_come_back_unwrapped(tmp_path):
    lapped = "    self.x[2] += 2 * np.pi * self.laps\n"
    once = CLASS.replace("motion.Q(u)\n", "motion.Q(u)\n    " + lapped).replace(
        "self.x, self.P = x, P", "self.x, self.P, self.laps = x, P, 1"
    )
    (tmp_path / "mine.py").write_text(once)
    assert apart(tmp_path / "mine.py", load_scene("square")) < 1e-9
    for to in ("motion.f(x, u) - [0, 0, 2 * np.pi],", "np.mod(motion.f(x, u), [9, 9, 2 * np.pi]),"):
        (tmp_path / "mine.py").write_text(FUNCTIONS.replace("motion.f(x, u),", to))
        assert apart(tmp_path / "mine.py", load_scene("square")) < 1e-9


def test_an_object_may_wrap_its_heading_when_it_likes(tmp_path):
    """Laps that it counted on its way and forgets at a reading are no degrees."""
    laps = CLASS.replace("motion.Q(u)\n", "motion.Q(u)\n        self.x[2] += 2 * np.pi * 3\n")
    seen = "        self.x[2] = np.angle(np.exp(1j * self.x[2])) + 0.01\n"
    (tmp_path / "mine.py").write_text(laps + seen)
    scene = replace(load_scene("tour"), filter=str(tmp_path / "mine.py"))
    *_, last = play(scene)
    assert last.entry.index == 30
