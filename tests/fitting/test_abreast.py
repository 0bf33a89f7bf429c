"""Sets of numbers that are tried side by side cost what each costs by itself."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from ekfsim import load_scene
from ekfsim.fitting import abreast
from ekfsim.fitting.likelihood import Likelihood
from ekfsim.fitting.noises import Retold, noises_of
from ekfsim.localization import entries_of, first_belief, play
from ekfsim.records import Log


def short(name, filter="ekf", entries=160):
    """The first entries of a simulated run, as a log."""
    scene = replace(load_scene(name), filter=filter, gate=None)
    return replace(scene, log=Log(tuple(islice(entries_of(scene), entries)), first_belief(scene)))


@pytest.mark.parametrize(("name", "filter"), [
    ("diverge-00-control", "ekf"), ("diverge-00-control", "ukf"), ("pylon", "ekf"),
    ("mower", "ekf"),
])  # fmt: skip
def test_side_by_side_they_are_as_one_by_one(name, filter):
    scene = short(name, filter, 4000 if name == "mower" else 160)
    retold = Retold(scene, tuple(one for one in noises_of(scene) if one.value > 0))
    assert abreast.possible(scene)
    told = np.array([one.value for one in retold.numbers])
    values = told * np.exp(np.random.default_rng(1).normal(size=(3, len(told))) / 3)
    n = len(scene.log.entries)
    each = [Likelihood().of(retold.with_(row.tolist(), n)) for row in values]
    assert len(set(each)) == 3
    assert Likelihood().of_all(retold, values, n) == pytest.approx(np.array(each), abs=1e-8)


def test_a_filter_that_looks_at_its_models_is_tried_one_by_one():
    scene = replace(short("diverge-00-control", entries=40), guard="skip")
    retold = Retold(scene, noises_of(scene))
    assert not abreast.possible(scene)
    assert not abreast.possible(replace(scene, filter="iekf", guard="warn"))
    values = np.array([[one.value for one in retold.numbers]])
    one = Likelihood().of(retold.with_(values[0].tolist(), 40))
    assert Likelihood().of_all(retold, values, 40) == pytest.approx([one])


def test_the_likelihood_is_that_of_the_normal_distribution():
    """Of readings of two numbers: the product of their densities, by scipy."""
    scene = short("pylon")
    density, numbers = 0.0, 0
    for step in play(scene):
        if (c := step.correction) is not None:
            density -= multivariate_normal.logpdf(c.innovation, cov=c.S)
            numbers += c.innovation.size
    assert numbers > 40
    assert Likelihood().of(scene) + numbers * np.log(2 * np.pi) / 2 == pytest.approx(density)


def test_a_robot_whose_errors_are_found_has_its_noises_still():
    """Those of the robot itself: told twice as large, its motion's noise is four times as large."""
    scene = load_scene("landmarks").with_("robot.estimate.wheelScale.sigma", 0.05)
    scene = replace(scene, log=Log(tuple(islice(entries_of(scene), 5)), first_belief(scene)))
    density = next(one for one in noises_of(scene) if one.key == "robot.headingDensity")
    entry = Retold(scene, (density,)).with_([2 * density.value]).log.entries[2]
    before = scene.log.entries[2].given
    M, M_before = entry.given.motion.M(before.u), before.motion.M(before.u)
    assert M[1, 1] == pytest.approx(4 * M_before[1, 1])
    assert M[0, 0] == M_before[0, 0]
