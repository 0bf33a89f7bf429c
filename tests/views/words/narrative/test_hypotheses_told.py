"""What is said of the hypotheses of mhekf, as the numbers of the run have it."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Mixture
from ekfsim.localization import play
from ekfsim.views.words.beams.hypotheses import SOUGHT, hypotheses, weights
from ekfsim.views.words.narrative.opening import opening


@pytest.fixture(scope="module")
def carried():
    """The steps of a robot that is carried away."""
    return list(play(replace(load_scene("kidnap"), filter="mhekf")))


def test_where_it_was_sought_elsewhere_is_told(carried):
    """The reading at which the heaviest hypothesis jumps is the one that is told."""
    told = [step for step in carried if SOUGHT in hypotheses(step)]
    (sought,) = told
    assert sought.entry.index > 10  # where the robot was carried away
    belief = sought.posterior
    found = (belief.parents < 0) & (belief.weights > 0)
    before = np.array(sought.prior.means)[sought.prior.weights > 0]
    apart = np.linalg.norm(belief.means[found][:, None, :2] - before[None, :, :2], axis=-1)
    assert apart.min() > 0.1
    assert f"sought: {found.sum()} of the hypotheses are found there\n" in hypotheses(sought)
    assert hypotheses(sought).count("; found elsewhere") == found.sum()
    assert weights(sought)[0].startswith(
        "no hypothesis explained the last readings: sought in the whole map; "
    )
    assert not any("found elsewhere" in hypotheses(s) for s in carried if s is not sought)


def test_every_hypothesis_has_its_weight_and_where_it_came_from(carried):
    parted = kept = 0
    for step in carried:
        told, belief = hypotheses(step), step.posterior
        if step.correction is None or not told:
            assert "weight" not in told
            continue
        assert isinstance(belief, Mixture)
        used = belief.weights[belief.weights > 0]
        lines = [line for line in told.splitlines() if line.startswith("  weight ")]
        assert [float(line.split()[1]) for line in lines] == pytest.approx(used, rel=1e-5)
        parents = belief.parents[belief.weights > 0].tolist()
        several = isinstance(step.prior, Mixture) and (step.prior.weights > 0).sum() > 1
        for line, parent in zip(lines, parents, strict=True):
            is_part = several and parent >= 0 and parents.count(parent) > 1
            assert ("; one part of the " in line) == is_part
            assert ("; was the " in line) == (several and parent >= 0 and not is_part)
            parted += is_part
            kept += "; was the " in line
        if len(used) > 1:
            heavy = ", ".join(f"{w:.2f}" for w in used if w >= 0.01)
            assert heavy in weights(step)[0]
    assert parted > 3
    assert kept > 3


def test_what_came_of_which_is_what_its_mean_says(carried):
    """A reading that all hypotheses take for the same wall moves each a little: the parent of each
    is the nearest before it.
    """
    compared = 0
    for step in carried:
        belief, prior = step.posterior, step.prior
        if step.correction is None or not isinstance(prior, Mixture):
            continue
        used, before = belief.weights > 0, prior.weights > 0
        parents = belief.parents[used]
        if (parents < 0).any() or len(set(parents)) < len(parents) or before.sum() < 2:
            continue
        assert set(parents) <= set(np.flatnonzero(before))
        for mean, parent in zip(belief.means[used], parents, strict=True):
            near = np.linalg.norm(prior.means[before] - mean, axis=-1)
            if np.sort(near)[1] > 3 * near.min():
                assert np.flatnonzero(before)[near.argmin()] == parent
                compared += 1
    assert compared > 3


def test_of_other_filters_nothing_is_told():
    for step in play(load_scene("square")):
        assert hypotheses(step) == ""
        assert weights(step) == []


@pytest.mark.parametrize("system", ["pioneer", "landmarks"])
def test_where_no_sensor_parts_it_is_the_ekf_and_says_so(system):
    scene = replace(load_scene(system), filter="mhekf")
    assert (
        "The filter mhekf: no sensor here tells which of several walls it may have met, so that "
        "there is one hypothesis, and it is the EKF\n"
    ) in opening(scene)
    assert "The filter mhekf: 8 hypotheses" in opening(replace(load_scene("tour"), filter="mhekf"))
    plain = islice(play(replace(scene, filter="ekf")), 200)
    for step, other in zip(islice(play(scene), 200), plain, strict=True):
        np.testing.assert_allclose(step.posterior.mean, other.posterior.mean, rtol=1e-9)
        P = other.posterior.covariance  # which the EKF's quicker twin rounds otherwise
        np.testing.assert_allclose(step.posterior.covariance, P, rtol=1e-9, atol=1e-12)
