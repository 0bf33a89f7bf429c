import math

import numpy as np
import pytest
from numerics import covariance, definite
from problems import Bent, landmark, problem

from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.ukf import UKF
from ekfsim.filters.variants.ukf_augmented import AugmentedUKF, augmented
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.raycast.walls import Walls


def by_hand(mean, P, function):
    """Weighted moments of a function over the sigma points of (x, noise), and its covariance with
    x; κ = 0."""
    n = len(mean)
    arms = math.sqrt(n) * np.linalg.cholesky(P).T
    points = np.concatenate([mean + arms, mean - arms])
    y = np.array([function(point) for point in points])
    ȳ = y.mean(axis=0)
    return ȳ, (y - ȳ).T @ (y - ȳ) / len(y), (points - mean).T @ (y - ȳ) / len(y)


@pytest.mark.parametrize("n", [3, 4, 7])
def test_state_and_noise_are_one_set_of_sigma_points(n):
    """Eqs 20 to 28, with X of state and noise, point by point."""
    for seed in range(5):
        random = np.random.default_rng(seed)
        model, x, P = (
            Bent(random, n),
            random.normal(size=n),
            0.1 * covariance(random, n) + 0.01 * np.eye(n),
        )
        M, Q, R = model.line.input_noise, model.line.process_noise, model.line.noise
        u, z = random.normal(size=2), random.normal(size=2)
        model.M, model.Q, model.G = (
            lambda u, M=M: M,
            lambda u, Q=Q: Q,
            lambda x, u, m=model: m.line.B,
        )
        model.F = lambda x, u, m=model: m.line.A
        one = augmented(x, P, M, Q)
        mean, P_new, _ = by_hand(
            *one, lambda X, m=model, u=u: m.f(X[:n], u + X[n : n + 2]) + X[n + 2 :]
        )
        filter = AugmentedUKF(headings=())
        belief, told = filter.predict(Gaussian(x, P), model, u)
        assert belief.mean == pytest.approx(mean, rel=1e-9, abs=1e-9)
        assert belief.covariance == pytest.approx(P_new, rel=1e-9, abs=1e-9)
        assert (told.F.shape, told.G.shape) == ((n, n), (n, 2))
        model.H, model.R = (lambda x: np.zeros((2, n))), lambda x, R=R: R
        ẑ, S, cross = by_hand(*augmented(x, P, R), lambda X, m=model: m.h(X[:n]) + X[n:])
        K = cross[:n] @ np.linalg.inv(S)
        posterior, correction = filter.update(Gaussian(x, P), model, z)
        assert correction.predicted == pytest.approx(ẑ, rel=1e-9, abs=1e-9)
        assert pytest.approx(S, rel=1e-8, abs=1e-9) == correction.S
        assert pytest.approx(K, rel=1e-7, abs=1e-8) == correction.K
        np.testing.assert_array_equal(correction.R, R)
        assert posterior.mean == pytest.approx(x + K @ (z - ẑ), rel=1e-7, abs=1e-7)
        assert posterior.covariance == pytest.approx(P - K @ S @ K.T, rel=1e-7, abs=1e-7)


def test_the_noise_of_a_turn_bends_the_way():
    """A robot that knows where it is turns by 0 ± 40° and drives 2 m: on average it comes less
    far."""
    first, u = Gaussian(np.zeros(3), np.zeros((3, 3))), np.array([2.0, 0.0])
    ahead = {
        type(filter): filter.predict(first, Twist(), u)[0].mean[0]
        for filter in (UKF(), AugmentedUKF())
    }
    w = 0.7 * np.random.default_rng(1).normal(size=100_000)
    assert ahead[AugmentedUKF] == pytest.approx(2 * np.cos(w).mean(), rel=0.03)
    assert ahead[UKF] == pytest.approx(2.0)  # which spreads that noise by G


class Twist:
    """Turn by u[1], unsure by 0.7 rad, then drive u[0]."""

    def f(self, x, u):
        θ = x[..., 2] + u[..., 1]
        return np.stack(
            [x[..., 0] + u[..., 0] * np.cos(θ), x[..., 1] + u[..., 0] * np.sin(θ), θ], axis=-1
        )

    def M(self, u):
        return np.diag([0.0, 0.7**2])

    def Q(self, u):
        return 0.0

    def G(self, x, u):
        θ, d = x[..., 2] + u[..., 1], u[..., 0]
        c, s, o = np.cos(θ), np.sin(θ), np.ones_like(θ)
        return np.stack(
            [np.stack([c, -d * s], -1), np.stack([s, d * c], -1), np.stack([0 * o, o], -1)], axis=-2
        )

    def F(self, x, u):
        return np.eye(3)

    def linearize(self, x, u):
        return self.f(x, u), self.F(x, u), self.G(x, u), self.M(u), self.Q(u)


def test_where_noise_is_only_added_it_is_the_ukf():
    """A linear problem: the points lie elsewhere, and what they say is the same."""
    random = np.random.default_rng(6)
    model = problem(random, 3, 2, 2)
    prior, z = Gaussian(random.normal(size=3), covariance(random, 3)), random.normal(size=2)
    a, b = (
        filter.update(prior, model, z)[0]
        for filter in (UKF(headings=()), AugmentedUKF(headings=()))
    )
    assert a.mean == pytest.approx(b.mean, abs=1e-9)
    assert a.covariance == pytest.approx(b.covariance, abs=1e-9)


def test_it_too_refuses_what_one_of_its_points_does_not_see():
    post = Walls.of({"post": np.array([[5, -0.2], [5.4, -0.2], [5.4, 0.2], [5, 0.2]])})
    prior, laser = Gaussian(np.zeros(3), np.diag([0.01, 0.01, 0.04])), Laser(post, 0.0, 0.01)
    posterior, correction = AugmentedUKF().update(prior, laser, np.array([5.0]))
    assert correction.refused == Refused.NO_WALL
    np.testing.assert_array_equal(posterior.covariance, prior.covariance)
    sure = Gaussian(np.zeros(3), np.diag([1e-4, 1e-4, 1e-6]))
    assert AugmentedUKF().update(sure, laser, np.array([5.0]))[1].refused == Refused.NOT


def test_a_bearing_at_the_turn_of_the_circle():
    prior = Gaussian(np.zeros(3), np.diag([0.01, 0.1, 0.05]))
    posterior, correction = AugmentedUKF().update(prior, landmark(-3.0, 0.0), np.array([3.0, -3.1]))
    assert abs(correction.innovation[1]) == pytest.approx(math.pi - 3.1, abs=1e-6)
    assert definite(posterior.covariance, 1e-12)


@pytest.mark.parametrize("degrees", [60, 104, 120, 180, 360])
def test_an_unknown_heading_stays_unknown_until_it_is_read(degrees):
    """Standing still without noise leaves P as it is, however wide; a compass then tells the
    heading."""
    P = np.diag([0.05, 0.05, math.radians(degrees)]) ** 2
    stood, _ = AugmentedUKF().predict(Gaussian(np.zeros(3), P), MoveTurn(0.1, 0.1), np.zeros(2))
    assert stood.covariance == pytest.approx(P, rel=1e-9, abs=1e-12)
    told, _ = AugmentedUKF().update(stood, Yaw(0.0, math.radians(1)), np.array([2.0]))
    assert told.mean[2] == pytest.approx(2.0, abs=1e-3)
    assert math.sqrt(told.covariance[2, 2]) == pytest.approx(math.radians(1), rel=1e-3)
