"""Run K of a study is run K played alone, to the last digit."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import rich
from systems_scenes import SCENES

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters import FILTERS
from ekfsim.localization import play
from ekfsim.study.block import run_block
from ekfsim.systems.drives import Stretch, Stretches

SOME = np.array([3, 1023, 1024, 2000])  # runs, of three blocks
SHORT = Stretches((Stretch(1.0, 0.2, 3.0),))


def ends(steps):
    """The last step of every instant: alone, a robot has no entries for what only others see."""
    last = {}
    for step in steps:
        last[step.entry.index if step.entry.t is None else step.entry.t] = step
    return list(last.values())


def agree(alone, batch, k, within):
    same = {"rtol": within, "atol": within}
    for one, many in zip(alone, batch, strict=True):
        np.testing.assert_allclose(many.entry.truth[k], one.entry.truth, **same)
        np.testing.assert_allclose(many.posterior.mean[k], one.posterior.mean, **same)
        np.testing.assert_allclose(many.posterior.covariance[k], one.posterior.covariance, **same)
        assert bool(many.nees.impossible[k]) == bool(one.nees.impossible)
        assert int(np.broadcast_to(many.nees.dof, SOME.shape)[k]) == int(one.nees.dof)
        np.testing.assert_allclose(
            many.nees.value[k], one.nees.value, rtol=1e3 * within, atol=1e3 * within
        )


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize(
    "made", ["tour", "rich", "pioneer", "gnss", *(scene.__name__ for scene in SCENES)]
)
def test_a_run_alone_is_its_row_of_the_batch(made, name):
    if made == "rich":
        scene = rich()
    elif made in ("tour", "pioneer", "gnss"):
        scene = load_scene(made)
        scene = scene if scene.drive is None else replace(scene, drive=SHORT)
    else:
        scene = replace(next(scene for scene in SCENES if scene.__name__ == made)(), drive=SHORT)
    scene = replace(scene, filter=name)
    if name == "amcl" and scene.world.anywhere is None:
        with pytest.raises(UsageError, match="map with a boundary"):
            list(play(scene, SOME))
        return
    batch = ends(play(scene, SOME))
    # kidnapped by 8 m, rounding errors grow as the linear algebra has them
    within = 1e-6 if made == "rich" else 1e-12
    for k, run in enumerate(SOME.tolist()):
        agree(ends(play(replace(scene, run=run))), batch, k, within)


@pytest.mark.parametrize("name", ["ekf", "ukf"])
@pytest.mark.parametrize(
    "made", ["tour", "diverge-01-wrong-wall", "diverge-03c-slip", "diverge-11-short-returns"]
)
def test_the_worst_run_of_a_packaged_scene_is_as_bad_when_it_is_played(made, name):
    """A lost filter magnifies rounding errors; not so much that another story were told."""
    scene = replace(load_scene(made), filter=name)
    worst = run_block(scene, 0, 1024).worst
    *_, last = play(replace(scene, run=worst.run))
    assert bool(last.nees.impossible) == worst.impossible
    assert float(last.nees.value) == pytest.approx(worst.nees, rel=1e-6)
