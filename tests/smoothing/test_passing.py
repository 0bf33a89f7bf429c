"""What is passed back over a motion: what it adds, and an inverse on the range alone."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numerics import covariance
from problems import begun, problem

import ekfsim
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.mixture.merging import moments
from ekfsim.filters.mixture.mhekf import MHEKF
from ekfsim.filters.mixture.places import mixed, placed
from ekfsim.localization import localize, play
from ekfsim.models.layout import POSE
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.records import Control, Entry, Step
from ekfsim.smoothing import smooth
from ekfsim.smoothing.passing import inverse_on_range, noise, slope


def moved(name, P, motion, u):
    """The step of one motion."""
    first = Gaussian(np.array([1.0, 2.0, 0.5]), P)
    entries = [Entry(0, None), Entry(1, Control(motion, u))]
    *_, step = localize(entries, begun(name, first), first, layout=POSE)
    return step


@pytest.mark.parametrize("name", ["ekf", "ukf", "ukf-augmented", "kf-nominal"])
def test_what_a_motion_adds_makes_up_what_the_filter_has(name):
    """P⁻ = F P Fᵀ + noise, however the filter came by it, of a motion that bends."""
    P = covariance(np.random.default_rng(2), 3) * 0.05
    step = moved(name, P, MoveTurn(0.05, 0.05), np.array([2.0, 0.6]))
    F = slope(step)
    whole = F @ step.prior.covariance @ F.T + noise(step, F)
    np.testing.assert_allclose(whole, step.posterior.covariance, rtol=1e-7, atol=1e-15)


def test_several_hypotheses_pass_on_the_covariance_of_all_together():
    """P_xy by points: those that stand for each Gaussian, moved along its own line. Of headings on
    either side of the seam, which are moved elsewhere.
    """
    motion, u = MoveTurn(0.05, 0.05), np.array([2.0, 0.6])
    means = np.array([[1.0, 2.0, 3.0], [4.0, 1.0, -3.0]])
    covariances = 0.05 * np.stack([covariance(np.random.default_rng(k), 3) for k in (2, 3)])
    weights = np.array([0.7, 0.3])
    x, P = moments(means, covariances, weights, (2,))
    before = replace(
        placed(mixed(Gaussian(x, P)), 2), means=means, covariances=covariances, weights=weights
    )
    after, told = MHEKF().predict(before, motion, u)
    entry = Entry(1, Control(motion, u))
    step = Step(entry, before, after, prediction=told, correction=None, nees=None, layout=POSE)
    F = slope(step)
    points, moved_, w = [], [], []
    for mean, C, weight in zip(means, covariances, weights, strict=True):
        root = np.sqrt(3) * np.linalg.cholesky(C).T
        spread = np.concatenate([root, -root])
        points.append(mean + spread)
        moved_.append(motion.f(mean, u) + spread @ motion.F(mean, u).T)
        w.append(np.full(6, weight / 6))

    def about(rows, mean):
        δ = np.concatenate(rows) - mean
        δ[:, 2] = (δ[:, 2] + np.pi) % (2 * np.pi) - np.pi
        return δ

    cross = about(points, x).T @ (np.concatenate(w)[:, None] * about(moved_, after.mean))
    np.testing.assert_allclose(P @ F.T, cross, atol=1e-12)
    assert np.linalg.eigvalsh(noise(step, F)).min() > 0  # and was below 0 by the heaviest's F
    assert np.linalg.eigvalsh(noise(step, told.F)).min() < 0


@pytest.mark.parametrize("scene", ["kidnap", "diverge-01-wrong-wall"])
def test_no_smoothed_variance_is_negative_where_hypotheses_are_several(scene):
    steps = play(replace(ekfsim.load_scene(scene), filter="mhekf"), np.arange(30))
    for step in smooth(steps):
        P = step.posterior.covariance
        σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 1e-12))
        assert np.linalg.eigvalsh(P / σ[..., :, None] / σ[..., None, :]).min() > -1e-6


def test_a_small_noise_keeps_its_digits_beside_a_large_covariance():
    """P = 10¹⁰, and 10⁻¹⁰ is added: the difference of the two covariances holds none of it."""
    model = replace(problem(np.random.default_rng(0), 3, 2, 1), process_noise=1e-10 * np.eye(3))
    model.A, model.B = np.eye(3), np.zeros((3, 2))
    step = moved("ekf", 1e10 * np.eye(3), model, np.zeros(2))
    np.testing.assert_allclose(noise(step, slope(step)), 1e-10 * np.eye(3), rtol=1e-12)


def test_the_inverse_is_that_of_numpy_on_the_directions_that_are_uncertain():
    """A line across the axes: rounding leaves a hair of variance beside it."""
    σ = np.array([3.0, 1e-4, 0.2])
    for rank in (1, 2):
        J = np.random.default_rng(rank).normal(size=(3, rank))
        C = J @ J.T / np.outer(np.linalg.norm(J, axis=1), np.linalg.norm(J, axis=1))
        wanted = np.linalg.pinv(C, rtol=1e-10, hermitian=True) / np.outer(σ, σ)
        got = inverse_on_range(C * np.outer(σ, σ))
        np.testing.assert_allclose(got, wanted, rtol=1e-6, atol=1e-9 * np.abs(wanted).max())


def test_what_is_certain_but_for_rounding_has_no_inverse_and_what_is_no_number_none():
    np.testing.assert_array_equal(
        inverse_on_range(np.diag([4.0, 1e-26, 0.0])), np.diag([0.25, 0, 0])
    )
    assert np.isnan(inverse_on_range(np.full((2, 2), np.nan))).all()


def test_each_step_begins_where_the_one_before_it_ends():
    """The smoothed prior is the smoothed posterior of the step before."""
    steps = smooth(play(ekfsim.load_scene("tour")))
    for one, following in pairwise(steps):
        np.testing.assert_array_equal(following.prior.mean, one.posterior.mean)
        np.testing.assert_array_equal(following.prior.covariance, one.posterior.covariance)
