import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numerics import covariance
from problems import problem
from scipy.stats import multivariate_normal

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.arithmetic.algebra import uncertain
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.cures.pdaf import PDAF
from ekfsim.filters.ekf import EKF
from ekfsim.localization import entries_of, first_belief, localize, play
from ekfsim.study.block import run_block
from ekfsim.twins import taking

seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize("k", [1, 2])
@given(seeds)
def test_the_moments_of_the_mixture(k, seed):
    """By Bayes, with SciPy's densities: the reading's part and the clutter's, each a Gaussian."""
    random = np.random.default_rng(seed)
    model, clutter, density = problem(random, 3, 2, k), 0.2, 0.05
    prior = Gaussian(random.normal(size=3), covariance(random, 3))
    z = model.C @ prior.mean + 3 * random.normal(size=k)
    S = model.C @ prior.covariance @ model.C.T + model.noise
    likely = multivariate_normal(model.C @ prior.mean, S).pdf(z)
    parts = np.array([(1 - clutter) * likely, clutter * density**k])
    β, rest = parts / parts.sum()
    own, _ = EKF(headings=()).update(prior, model, z)
    mean = β * own.mean + rest * prior.mean
    P = sum(
        weight * (part.covariance + np.outer(part.mean - mean, part.mean - mean))
        for weight, part in ((β, own), (rest, prior))
    )
    filter = PDAF(headings=(), clutter=clutter, density=density)
    (x, covered), told = filter.update(prior, model, z)
    assert float(told.trust) == pytest.approx(β, rel=1e-6, abs=1e-12)
    assert x == pytest.approx(mean, rel=1e-6, abs=1e-8)
    assert covered == pytest.approx(P, rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("way", ["plain", "quick"])
@pytest.mark.parametrize("runs", [None, np.arange(70)])
def test_without_clutter_it_is_the_ekf_to_the_bit(way, runs):
    scene = load_scene("diverge-11-short-returns")
    first = first_belief(scene, () if runs is None else runs.shape)
    with taking(way):
        entries = list(entries_of(scene, runs))
        steps = (localize(entries, one, first) for one in (EKF(), PDAF(clutter=0.0)))
        for plain, other in zip(*steps, strict=True):
            assert np.array_equal(plain.posterior.mean, other.posterior.mean)
            assert np.array_equal(plain.posterior.covariance, other.posterior.covariance)


def read(x, P, z, R, headings=()):
    model = replace(problem(np.random.default_rng(0), 1, 1, 1), C=np.eye(1), noise=np.array([[R]]))
    prior = Gaussian(np.array([x]), np.array([[P]]))
    return PDAF(headings=headings).update(prior, model, np.array([z]))


def test_the_innovation_of_zero_certainty_and_what_is_out_of_reach():
    """Rule 20; and an innovation whose density is 0 in doubles leaves the prior as it is."""
    (x, _), told = read(1.0, 3.0, 1.0, 1.0)
    by_hand = 0.9 / math.sqrt(8 * math.pi) / (0.9 / math.sqrt(8 * math.pi) + 0.01)
    assert (x.item(), float(told.trust)) == (1.0, pytest.approx(by_hand, rel=1e-12))
    (x, P), told = read(1.0, 0.0, 9.0, 0.0)
    assert (x.item(), P.item(), math.isnan(float(told.trust))) == (1.0, 0.0, True)
    for z in (1e3, -1e3):
        (x, P), told = read(0.0, 3.0, z, 1.0)
        assert (x.item(), P.item()) == pytest.approx((0.0, 3.0), abs=1e-12)
    (x, _), told = read(math.pi - 0.1, 3.0, math.pi + 0.3, 1.0, (0,))
    assert x.item() == pytest.approx(-math.pi - 0.1 + 0.3 * float(told.trust))


@pytest.mark.parametrize(
    ("scene", "low", "high"),
    [
        ("01-wrong-wall", 0, 0.02), ("11-short-returns", 0, 0.02), ("09-wrong-start", 0.7, 0.9),
        ("03c-slip", 0.97, 1),
    ],
)  # fmt: skip
def test_what_it_cures_and_where_it_dies(scene, low, high):
    """Of 300 runs; of 1000 it is 0.2, 0.3, 79.8 and 100 %."""
    tally = run_block(replace(load_scene(f"diverge-{scene}"), filter="pdaf"), 0, 300)
    assert low <= sum(tally.lost_from.values()) / 300 <= high


def test_the_narrative_tells_beta():
    from ekfsim.views.playback.playback import views
    from ekfsim.views.words.narrative.narrating import narrate

    scene = replace(load_scene("diverge-01-wrong-wall"), filter="pdaf")
    short, long = (
        "".join(narrate(view, scene, explain=explain) for view in views(play(scene)))
        for explain in (False, True)
    )
    assert "was expected and no clutter, is 0.935995\n" in short
    assert "c = 0.1 of readings clutter, lambda = 0.1 per m)" in long


@pytest.mark.parametrize(("off", "spare"), [(0.3, 0.0), (4.0, 0.0), (4.0, 0.7)])
def test_a_number_that_is_certain_among_several_tells_nothing(off, spare):
    """S is singular there, and β that of the other numbers, wherever the certain one lies; with a
    scale so small that its determinant is no measure.
    """
    x, P = np.array([1.0, 2.0, 0.3]), np.diag([0.04, 0.0, 1e-16])
    filter = PDAF(headings=(), clutter=0.2, density=0.05)
    some = problem(np.random.default_rng(0))
    alone = replace(some, C=np.eye(3)[:1], noise=np.array([[0.01]]))
    several = replace(some, C=np.eye(3)[:2], noise=np.diag([0.01, 0.0]))
    expected, told = filter.update(Gaussian(x, P), alone, x[:1] + off)
    found, also = filter.update(Gaussian(x, P), several, x[:2] + np.array([off, spare]))
    likely = 0.8 * multivariate_normal(0, 0.05).pdf(off)
    assert float(told.trust) == pytest.approx(likely / (likely + 0.2 * 0.05), rel=1e-9)
    assert float(also.trust) == pytest.approx(float(told.trust), rel=1e-9)
    np.testing.assert_allclose(found.mean, expected.mean, atol=1e-12)
    np.testing.assert_allclose(found.covariance, expected.covariance, atol=1e-12)


def test_which_numbers_are_uncertain_their_correlations_say():
    """Metres and nanoradians mixed."""
    units = np.array([1.0, 1e-9, 1e6])
    for rank in (0, 1, 2, 3):
        root = np.random.default_rng(rank).normal(size=(3, rank))
        S = root @ root.T
        k, ln_det = uncertain(units[:, None] * S * units)
        assert k == rank
        if rank == 3:
            assert ln_det == pytest.approx(np.linalg.slogdet(S)[1] + 2 * np.log(units).sum())
    k, ln_det = uncertain(np.stack([np.diag([4.0, 9.0, 0.0]), np.zeros((3, 3))]))
    assert k.tolist() == [2, 0]
    assert ln_det == pytest.approx([np.log(36), 0.0])
