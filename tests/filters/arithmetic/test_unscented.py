import math

import numpy as np
import pytest
from filterpy.kalman import JulierSigmaPoints, MerweScaledSigmaPoints
from numerics import covariance, definite

from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.arithmetic.unscented import (
    nearest_definite,
    sigma_points,
    statistical_slope,
    unscented_transform,
    weighted_mean,
    weights,
)


def cartesian(polar):
    r, θ = polar[..., 0], polar[..., 1]
    return np.stack([r * np.cos(θ), r * np.sin(θ)], axis=-1)


@pytest.mark.parametrize(
    ("settings", "mean_y", "var_x", "var_y"),
    [
        ({"kappa": 1}, 0.966314, 0.063968, 0.002670),
        ({"kappa": 0}, 0.966120, 0.065464, 0.001548),
        ({"alpha": 1e-3, "beta": 2, "kappa": 0}, 0.965731, 0.068539, 0.002749),
        ({}, 0.966314, 0.063968, 0.002670),  # n + κ = 3
    ],
)
def test_a_polar_reading_of_document_001(settings, mean_y, var_x, var_y):
    """Range 1 m ± 2 cm, bearing 90° ± 15°."""
    P = np.diag([0.02, math.radians(15)]) ** 2
    done = unscented_transform(np.array([1, math.pi / 2]), P, cartesian, weights(2, **settings))
    assert done.mean == pytest.approx([0, mean_y], abs=1e-6)
    assert done.covariance == pytest.approx(np.diag([var_x, var_y]), abs=1e-6)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 7])
def test_points_and_weights_are_those_of_filterpy(n):
    random = np.random.default_rng(n)
    x, P = random.normal(size=n), covariance(random, n)
    for kappa in (0.0, 1.0, 3.0 - n if n < 4 else 0.5):
        theirs = JulierSigmaPoints(n, kappa)
        ours = weights(n, kappa=kappa)
        assert ours.mean == pytest.approx(theirs.Wm)
        assert ours.covariance == pytest.approx(theirs.Wc)
        assert sigma_points(x, square_root(P), ours.spread) == pytest.approx(
            theirs.sigma_points(x, P), abs=1e-12
        )
        for alpha, beta in ((1e-1, 2.0), (0.5, 1.0)):
            theirs, ours = (
                MerweScaledSigmaPoints(n, alpha, beta, kappa),
                weights(n, alpha, beta, kappa),
            )
            assert ours.mean == pytest.approx(theirs.Wm)
            assert ours.covariance == pytest.approx(theirs.Wc)
            assert sigma_points(x, square_root(P), ours.spread) == pytest.approx(
                theirs.sigma_points(x, P), abs=1e-12
            )


def test_weights_that_reach_nowhere():
    with pytest.raises(
        ValueError, match=r"alpha² \(n \+ kappa\) must be positive, not -1: alpha=1, n=2, kappa=-3"
    ):
        weights(2, kappa=-3.0)


@pytest.mark.parametrize("rank", [0, 1, 2, 3])
def test_the_root_of_any_covariance(rank):
    random = np.random.default_rng(rank)
    P = covariance(random, 50, 3, rank=rank) if rank else np.zeros((50, 3, 3))
    P[::2] *= np.array([1e-6, 1, 1e3])[:, None] * np.array([1e-6, 1, 1e3])  # units must not matter
    P[1, 1] = P[1, :, 1] = 0
    L = square_root(P)
    scale = np.sqrt(np.diagonal(P, axis1=1, axis2=2)) + 1e-30
    assert (np.tril(L) == L).all()
    error = (L @ L.mT - P) / (scale[:, :, None] * scale[:, None, :])
    assert error == pytest.approx(0, abs=1e-6 if 0 < rank < 3 else 1e-12)
    assert square_root(P[5]) == pytest.approx(L[5], abs=1e-15)
    if rank == 3:
        assert L[2:] == pytest.approx(np.linalg.cholesky(P[2:]), rel=1e-7)


def test_a_mean_of_directions_is_a_direction():
    for turn in (0.0, 1.0, math.pi, -math.pi + 0.01):
        points = np.array([[0.0], [0.2], [-0.2]]) + turn
        points = np.arctan2(np.sin(points), np.cos(points))
        mean = weighted_mean(points, np.array([0.5, 0.3, 0.2]), (0,))
        expected = math.atan2(0.1 * math.sin(0.2), 0.5 + 0.5 * math.cos(0.2)) + turn
        assert math.remainder(mean[0] - expected, 2 * math.pi) == pytest.approx(0, abs=1e-14)
        assert -math.pi < mean[0] <= math.pi
    many = np.array([[3.1], [-3.1], [-3.1]])
    assert weighted_mean(many, np.array([-1e6 + 1, 5e5, 5e5]), (0,))[0] == pytest.approx(
        math.atan2(
            (-1e6 + 1) * math.sin(3.1) - 1e6 * math.sin(3.1),
            (-1e6 + 1) * math.cos(3.1) + 1e6 * math.cos(3.1),
        ),
        abs=1e-6,
    )


@pytest.mark.parametrize("rank", [1, 2, 3])
def test_the_slope_that_stands_for_a_derivative(rank):
    """P_yx P⁺, of a straight line the line itself, where there is anything to see of it."""
    random = np.random.default_rng(rank + 10)
    A = random.normal(size=(2, 3))
    P = covariance(random, 6, 3, rank=rank)
    P[4, 1] = P[4, :, 1] = 0
    done = unscented_transform(random.normal(size=(6, 3)), P, lambda x: np.matvec(A, x), weights(3))
    H = statistical_slope(done.slope, done.root)
    assert done.cross == pytest.approx(P @ A.T, abs=1e-9)
    assert done.bend == pytest.approx(0, abs=1e-12)
    assert done.covariance == pytest.approx(A @ P @ A.T, abs=1e-9)
    for i in range(6):
        expected = A @ P[i] @ np.linalg.pinv(P[i], rcond=1e-9)
        assert H[i] == pytest.approx(expected, abs=1e-6)
        one = unscented_transform(np.zeros(3), P[i], lambda x: np.matvec(A, x), weights(3))
        assert statistical_slope(one.slope, one.root) == pytest.approx(expected, abs=1e-6)


def test_negative_weights_leave_a_covariance():
    P = np.array([[1.0, 2.0], [2.0, 1.0]])  # eigenvalues 3 and −1
    assert nearest_definite(P) == pytest.approx(np.full((2, 2), 1.5))
    assert definite(nearest_definite(P))
