"""A filter of one's own localizes as the EKF does."""

from dataclasses import replace

import numpy as np
import pytest
from files import CLASS, FUNCTIONS

from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play


def apart(place, scene="tour"):
    """By how many σ, of at least 1e-6, a filter of one's own and the EKF differ at most."""
    scene = load_scene(scene)
    most = 0.0
    for own, ekf in zip(play(replace(scene, filter=str(place))), play(scene), strict=True):
        assert own.entry.index == ekf.entry.index
        (x, P), (x0, P0) = own.posterior, ekf.posterior
        σ = np.maximum(np.sqrt(np.diagonal(P0)), 1e-6)
        δ = x - x0
        δ[2] = np.angle(np.exp(1j * δ[2]))
        most = max(most, np.abs(δ / σ).max(), np.abs((P - P0) / np.outer(σ, σ)).max())
    return most


@pytest.mark.parametrize("code", [FUNCTIONS, CLASS], ids=["functions", "class"])
def test_twelve_lines_equal_the_ekf(tmp_path, code):
    (tmp_path / "mine.py").write_text(code)
    assert apart(tmp_path / "mine.py") < 1e-9
