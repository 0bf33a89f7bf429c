import math
from dataclasses import replace

import numpy as np
import pytest
from problems import ROOM, begun, classroom, landmark
from scipy.stats import multivariate_normal

from ekfsim.filters.belief import Gaussian, Particles, Refused
from ekfsim.filters.pf import PF, systematic
from ekfsim.filters.protocol import Beginning
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.wheels import GyroWheels
from ekfsim.models.protocols import Quantity
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls

POST = Walls.of({"post": np.array([[5, -0.2], [5.4, -0.2], [5.4, 0.2], [5, 0.2]])})


def one(seed=0, count=500, **settings):
    return PF((np.random.default_rng(seed),), count=count, **settings)


def crowd(states, weights=None):
    states = np.array(states, float)
    weights = np.full(len(states), 1 / len(states)) if weights is None else np.array(weights)
    return Particles(weights @ states, np.cov(states.T, aweights=weights, ddof=0), states, weights)


def test_it_needs_something_to_draw_from():
    first = Gaussian(np.zeros(3), np.eye(3))
    with pytest.raises(ValueError, match="needs generators"):
        PF.begin(Beginning(first))


def test_the_same_seed_draws_the_same():
    first, laser, motion = classroom(np.random.default_rng(1))
    beliefs = []
    for seed in (5, 5, 6):
        filter = begun("pf", first, seed=seed)
        belief, _ = filter.predict(first, motion, np.array([0.5, 0.2]))
        beliefs.append(filter.update(belief, laser, laser.h(first.mean))[0])
    assert (beliefs[0].states == beliefs[1].states).all()
    assert (beliefs[0].states != beliefs[2].states).any()


def test_a_gaussian_is_drawn_and_stands_for_itself():
    """The crowd of a first belief tells the belief's own mean and covariance until a reading is
    used."""
    P = np.diag([0.04, 0.01, 0.09])
    prior = Gaussian(np.array([3.0, 4.0, 3.1]), P)
    posterior, _ = one(count=20_000).update(prior, Laser(ROOM, 0.0, 0.01), np.array([np.nan]))
    assert (posterior.mean == prior.mean).all()
    assert (posterior.covariance == P).all()
    δ = posterior.states - prior.mean
    δ[:, 2] = np.arctan2(np.sin(δ[:, 2]), np.cos(δ[:, 2]))
    assert np.cov(δ.T) == pytest.approx(P, abs=0.003)
    assert np.abs(posterior.states[:, 2]).max() <= math.pi
    assert posterior.weights.sum() == pytest.approx(1)


def test_the_noise_of_inputs_and_of_the_process():
    """x⁺ = f(x, u) + G w + q: covariance G M Gᵀ + Q where the first belief is certain."""
    Q = np.diag([1e-4, 2e-4, 1e-3])
    motion, u = GyroWheels(0.5, 0.02, Q, 0.1), np.array([0.3, 0.2, 0.5, 0.1])
    first = Gaussian(np.array([0.0, 0.0, 1.0]), np.zeros((3, 3)))
    belief, prediction = one(count=50_000).predict(first, motion, u)
    expected = prediction.G @ motion.M(u) @ prediction.G.T + Q
    scale = np.sqrt(np.diag(expected))
    assert belief.covariance / np.outer(scale, scale) == pytest.approx(
        expected / np.outer(scale, scale), abs=0.03
    )
    assert belief.mean == pytest.approx(
        motion.f(first.mean, u), abs=5 * scale.max() / math.sqrt(50_000)
    )
    turned, _ = one().predict(
        Gaussian(np.array([0.0, 0.0, math.pi]), np.zeros((3, 3))), motion, u * (1, 1, 0, 1)
    )
    assert np.abs(turned.states[:, 2]).max() <= math.pi


def test_weights_are_likelihoods():
    states = np.array([[3.0, 4.0, 0.0], [3.5, 4.0, 0.0], [2.0, 4.0, 0.0], [3.1, 4.0, 0.0]])
    laser = Laser(ROOM, 0.0, 0.2)
    prior = crowd(states, [0.25, 0.3, 0.2, 0.25])
    posterior, c = replace(one(), count=4).update(prior, laser, np.array([6.8]))
    r, σ = 10 - states[:, 0], 0.2 * (10 - states[:, 0])
    spread = np.sum(prior.weights * (r - prior.weights @ r) ** 2)
    σ2 = σ**2 + spread * (10 / 4) ** 2  # four particles are no crowd
    expected = prior.weights * np.exp(-((6.8 - r) ** 2) / (2 * σ2)) / np.sqrt(σ2)
    assert posterior.weights == pytest.approx(expected / expected.sum())
    assert (posterior.states == states).all()  # more than half of them count
    assert c.predicted == pytest.approx([prior.weights @ r])
    assert pytest.approx(spread + prior.weights @ σ**2) == c.S
    assert c.nis == pytest.approx((6.8 - prior.weights @ r) ** 2 / c.S[0, 0])
    assert c.K[0, 0] == pytest.approx(-spread / c.S[0, 0])


class Growing:
    """Two numbers at once whose noise grows with the second, and goes along with it."""

    outputs = (Quantity("z0", "m"), Quantity("z1", "m"))

    def linearize(self, x):
        R = (1 + x[..., 1, None, None] ** 2) * np.array([[0.5, 0.3], [0.3, 0.7]])
        return x[..., :2], np.broadcast_to(np.eye(2, 3), (*x.shape[:-1], 2, 3)), R

    def residual(self, z, h):
        return z - h


def test_two_numbers_at_once_weigh_by_their_density():
    states, z = np.random.default_rng(2).normal(size=(1000, 3)), np.array([0.1, 0.2])
    prior = crowd(states)
    posterior, correction = PF((np.random.default_rng(0),), headings=(), count=1000).update(
        prior, Growing(), z
    )
    R = Growing().linearize(states)[2] + np.cov(states[:, :2].T, ddof=0) * 10 / 1000
    expected = np.array(
        [multivariate_normal.pdf(z, x[:2], r) for x, r in zip(states, R, strict=True)]
    )
    assert posterior.weights == pytest.approx(expected / expected.sum(), rel=1e-6)
    assert pytest.approx(Growing().linearize(states)[2].mean(axis=0)) == correction.R


def test_a_particle_that_sees_nothing_explains_nothing():
    states = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.01], [0.0, 0.0, 2.0], [0.0, 0.1, -0.02]])
    filter, laser = replace(one(), count=4), Laser(POST, 0.0, 0.05)
    posterior, correction = filter.update(crowd(states), laser, np.array([5.0]))
    assert posterior.weights[2] == 0
    assert correction.refused == Refused.NOT
    assert correction.predicted == pytest.approx(
        [(5 + 4.9 / math.cos(0.01) + 5 / math.cos(0.02)) / 3]
    )
    assert np.isfinite(correction.nis)
    away = crowd([[0, 0, 3.0], [0, 0, 2.0], [0, 0, -2.0], [0, 0, 3.1]])
    posterior, correction = filter.update(away, laser, np.array([5.0]))
    assert correction.refused == Refused.NO_WALL
    assert (posterior.states == away.states).all()
    assert (posterior.weights == away.weights).all()
    assert np.isfinite(correction.K).all()


def test_a_reading_beyond_all_particles_divides_by_nothing():
    """exp(−½ 10⁸) is 0: the nearest takes all the weight."""
    first = Gaussian(np.array([3.0, 4.0, 0.0]), np.diag([1e-4, 1e-4, 1e-6]))
    posterior, correction = one().update(first, Laser(ROOM, 0.0, 1e-6), np.array([9.0]))
    assert correction.refused == Refused.NOT
    assert np.isfinite(posterior.mean).all()
    assert posterior.weights.sum() == pytest.approx(1)
    assert posterior.mean[0] < 3.0


def test_a_perfect_sensor_keeps_the_nearest():
    first = Gaussian(np.array([3.0, 4.0, 0.0]), np.diag([0.01, 0.01, 0.0]))
    posterior, _ = one().update(first, Laser(ROOM, 0.0, 0.0), np.array([6.9]))
    assert posterior.mean[0] == pytest.approx(3.1, abs=0.005)
    assert posterior.covariance[1, 1] == pytest.approx(0.01, rel=0.8)


def test_systematic_resampling():
    """Each particle is hit p wᵢ times, rounded up or down, and in the long run exactly."""
    random = np.random.default_rng(3)
    weights = random.dirichlet(np.full(50, 0.3), size=(2, 200))
    weights[0, 0] = np.eye(50)[49]
    weights[0, 1] = np.eye(50)[0]
    u = random.random((2, 200))
    u[0, :3] = 0.0
    hit = systematic(weights, u)
    assert hit.shape == weights.shape
    times = np.apply_along_axis(np.bincount, -1, hit, minlength=50)
    assert (np.abs(times - 50 * weights) < 1 + 1e-9).all()
    assert (times[weights == 0] == 0).all()
    for i in ((0, 5), (1, 7)):
        ends = np.cumsum(weights[i])
        assert (
            hit[i] == np.searchsorted(ends / ends[-1], (np.arange(50) + u[i]) / 50, side="right")
        ).all()


def test_drawn_anew_they_keep_mean_and_covariance_and_are_parted():
    first = Gaussian(np.array([3.0, 4.0, 3.1]), np.diag([0.09, 0.09, 0.01]))
    mark = landmark(6.0, 5.0, 0.2, 0.05)
    posterior, _ = one(count=20_000).update(first, mark, mark.h(first.mean) + np.array([0.1, 0.02]))
    assert (posterior.weights == 1 / 20_000).all()
    assert len(np.unique(posterior.states[:, 0])) == 20_000
    states = np.random.default_rng(1).multivariate_normal(*first, size=400_000)
    ν = mark.residual(mark.h(first.mean) + np.array([0.1, 0.02]), mark.h(states))
    likelihood = np.exp(-0.5 * np.sum((ν / (0.2, 0.05)) ** 2, axis=1))
    mean, P = np.average(states, axis=0, weights=likelihood), np.cov(states.T, aweights=likelihood)
    δ = posterior.mean - mean
    scale = np.sqrt(np.diag(P))
    assert np.array([*δ[:2], math.remainder(δ[2], 2 * math.pi)]) / scale == pytest.approx(
        0, abs=0.03
    )
    assert (posterior.covariance - P) / np.outer(scale, scale) == pytest.approx(0, abs=0.03)


def test_it_holds_two_places_at_once():
    """A corridor seen at right angles from either wall: a Kalman filter would choose the middle."""
    random = np.random.default_rng(4)
    states = np.concatenate(
        [random.normal((3, 2, 0), 0.05, (250, 3)), random.normal((7, 2, math.pi), 0.05, (250, 3))]
    )
    states[:, 2] = np.arctan2(np.sin(states[:, 2]), np.cos(states[:, 2]))
    filter, belief = one(), crowd(states)
    for _ in range(3):
        belief, correction = filter.update(belief, Laser(ROOM, 0.0, 0.02), np.array([7.0]))
    assert correction.refused == Refused.NOT
    left = belief.states[:, 0] < 5
    assert 0.2 < belief.weights[left].sum() < 0.8
    assert belief.covariance[0, 0] > 1


def test_generators_and_runs_must_match():
    first = Gaussian(np.zeros((3, 3)), np.tile(np.eye(3), (3, 1, 1)))
    with pytest.raises(ValueError, match="reshape"):
        one().predict(first, MoveTurn(0.1, 0.1), np.zeros(2))
