"""Whole runs by the quick ways are those of the readable text, and a study's runs are those runs
alone."""

import dataclasses
import itertools

import numpy as np
import pytest
from scenes import rich, unbounded
from ways import WAYS

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Refused
from ekfsim.localization import play
from ekfsim.twins import taking

NEAR = {"rtol": 1e-12, "atol": 1e-12}
STEPS = 24  # of each scene, after its start
CERTAIN = 1e-9  # m, rad; in place of a smaller standard deviation
CLASSROOM = [
    name
    for name in packaged("commands")
    if name.startswith(("diverge-", "proof-", "square", "theta", "tour"))
]


@pytest.mark.parametrize("runs", [None, 64])
@pytest.mark.parametrize("name", CLASSROOM)
def test_a_scene_is_the_same_in_the_plain_way(name, runs):
    """To a thousand-millionth of the standard deviations, and with every decision taken alike."""
    scene = load_scene(name)
    numbers = None if runs is None else np.arange(runs)
    with taking("plain"):
        plain = list(itertools.islice(play(scene, numbers), STEPS))
    with taking("quick"):
        quick = list(itertools.islice(play(scene, numbers), STEPS))
    assert len(plain) > 1
    for one, other in zip(quick, plain, strict=True):
        x, P = other.posterior
        σ = np.maximum(np.sqrt(np.diagonal(P, axis1=-2, axis2=-1)), CERTAIN)
        assert (np.abs(one.posterior.mean - x) <= 1e-9 * σ).all()
        assert (
            np.abs(one.posterior.covariance - P) <= 1e-9 * σ[..., :, None] * σ[..., None, :]
        ).all()
        if other.correction is not None:
            np.testing.assert_array_equal(one.correction.refused, other.correction.refused)
            np.testing.assert_allclose(one.correction.nis, other.correction.nis, rtol=1e-9)


@pytest.mark.parametrize("name", WAYS)
@pytest.mark.parametrize(
    ("made", "reasons"), [(rich(), 3), (unbounded(), 3), (rich(gate=None, guard="skip"), 3)]
)
def test_a_run_of_a_study_is_that_run_alone(name, made, reasons):
    runs, met = np.arange(900, 1024), set()
    some = [0, 1, 60, 123]
    alone = [list(play(dataclasses.replace(made, run=int(runs[k])))) for k in some]
    with taking(name):
        for i, step in enumerate(play(made, runs)):
            for k, one in zip(some, (steps[i] for steps in alone), strict=True):
                np.testing.assert_allclose(step.entry.truth[k], one.entry.truth, **NEAR)
                np.testing.assert_allclose(
                    step.posterior.mean[k], one.posterior.mean, rtol=1e-12, atol=1e-11
                )
                np.testing.assert_allclose(
                    step.posterior.covariance[k], one.posterior.covariance, **NEAR
                )
                assert step.nees.dof[k] == one.nees.dof
                if one.correction:
                    assert step.correction.refused[k] == one.correction.refused
            if step.correction:
                met |= set(step.correction.refused.tolist())
    assert len(met) >= reasons, [Refused(each) for each in met]
