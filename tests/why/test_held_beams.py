"""Whatever filter a run is of: a changed beam is that of each of its runs, side by side too."""

from dataclasses import replace

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.filters import FILTERS
from ekfsim.why.changes import beams
from ekfsim.why.trying.replaying import replayed

SLIP = load_scene("diverge-03c-slip")
RUNS = np.array([3, 5])  # the iterated filter's searches of these end at different steps


@pytest.mark.parametrize("change", [beams.WALL, beams.ASTRAY, beams.NOISE_AT_TRUTH])
@pytest.mark.parametrize("name", FILTERS)
def test_runs_side_by_side_have_each_its_own_beams(name, change):
    scene = replace(SLIP, filter=name, tuning=replace(SLIP.tuning, particles=100))
    *_, last = replayed(scene, (change,), RUNS)
    for row, run in enumerate(RUNS):
        *_, alone = replayed(replace(scene, run=int(run)), (change,))
        both = last.posterior.mean[row], alone.posterior.mean
        np.testing.assert_allclose(*both, rtol=1e-6, atol=1e-6)
