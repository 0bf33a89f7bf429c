import math
from dataclasses import replace

import numpy as np
import pytest
from filterpy.kalman import JulierSigmaPoints, MerweScaledSigmaPoints, UnscentedKalmanFilter
from numerics import covariance, definite
from problems import Bent, close, landmark, problem
from systems_scenes import gnss

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.arithmetic.unscented import reach
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.ekf import EKF
from ekfsim.filters.ukf import UKF
from ekfsim.localization import play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.systems.drives import Circle


def settings(n):
    yield JulierSigmaPoints(n, 0.7), {"kappa": 0.7}
    yield MerweScaledSigmaPoints(n, 0.6, 2.0, 1.0), {"alpha": 0.6, "beta": 2.0, "kappa": 1.0}
    yield MerweScaledSigmaPoints(n, 1.2, 0.0, 0.0), {"alpha": 1.2, "kappa": 0.0}


@pytest.mark.parametrize("n", [2, 3, 4, 7])
def test_it_is_that_of_filterpy(n):
    """Which updates with the points that it has moved: so they are drawn afresh before."""
    for seed in range(10):
        random = np.random.default_rng(seed)
        model = Bent(random, n)
        x, P = random.normal(size=n), 0.1 * covariance(random, n) + 0.01 * np.eye(n)
        u, z = random.normal(size=2), random.normal(size=2)
        for points, chosen in settings(n):
            filter, other = (
                UKF(headings=(), **chosen),
                UnscentedKalmanFilter(n, 2, 1.0, model.h, None, points),
            )
            other.x, other.P, other.R = x.copy(), P.copy(), model.line.noise
            other.Q = (
                model.line.B @ model.line.input_noise @ model.line.B.T + model.line.process_noise
            )
            other.predict(fx=lambda x, dt: model.f(x, u))  # noqa: B023
            belief, _ = filter.predict(Gaussian(x, P), model, u)
            assert belief.mean == pytest.approx(other.x, rel=1e-10, abs=1e-10)
            assert belief.covariance == pytest.approx(other.P, rel=1e-10, abs=1e-10)
            other.sigmas_f = points.sigma_points(other.x, other.P)
            other.update(z)
            belief, correction = filter.update(belief, model, z)
            assert pytest.approx(other.S, rel=1e-9, abs=1e-9) == correction.S
            assert pytest.approx(other.K, rel=1e-8, abs=1e-9) == correction.K
            assert correction.innovation == pytest.approx(other.y, rel=1e-9, abs=1e-9)
            assert belief.mean == pytest.approx(other.x, rel=1e-8, abs=1e-8)
            assert belief.covariance == pytest.approx(other.P, rel=1e-8, abs=1e-8)


def test_equation_28():
    """P = P⁻ − K S Kᵀ, and H told is P_zx P⁺."""
    random = np.random.default_rng(0)
    prior = Gaussian(random.normal(size=3), covariance(random, 3))
    posterior, c = UKF().update(prior, landmark(), np.array([2.0, 0.1]))
    assert posterior.covariance == pytest.approx(prior.covariance - c.K @ c.S @ c.K.T, abs=1e-12)
    assert pytest.approx((c.H @ prior.covariance).T, abs=1e-12) == c.K @ c.S
    # what the bend of h adds
    assert np.linalg.eigvalsh(c.S - c.R - c.H @ prior.covariance @ c.H.T).min() > 0


def test_a_wide_prior_knows_that_a_landmark_may_be_on_either_side():
    """The mean of bearings near ±180° lies there, not at 0."""
    prior = Gaussian(np.zeros(3), np.diag([0.01, 0.5, 0.1]))
    _, correction = UKF().update(prior, landmark(-3.0, 0.0), np.array([3.0, -3.1]))
    assert abs(correction.predicted[1]) == pytest.approx(math.pi, abs=1e-6)
    assert abs(correction.innovation[1]) == pytest.approx(math.pi - 3.1, abs=1e-6)
    assert correction.S[1, 1] < 0.3


def test_one_point_without_a_wall_refuses_the_reading():
    """The mean meets a wall; a point of its uncertainty looks past the post."""
    post = Walls.of({"post": np.array([[5, -0.2], [5.4, -0.2], [5.4, 0.2], [5, 0.2]])})
    prior, laser = Gaussian(np.zeros(3), np.diag([0.01, 0.01, 0.04])), Laser(post, 0.0, 0.01)
    assert laser.h(prior.mean) == 5
    posterior, correction = UKF().update(prior, laser, np.array([5.0]))
    assert correction.refused == Refused.NO_WALL
    assert (posterior.mean == prior.mean).all()
    assert np.isnan(correction.predicted).all()
    assert np.isfinite(correction.H).all()
    sure = Gaussian(np.zeros(3), np.diag([1e-4, 1e-4, 1e-6]))
    assert UKF().update(sure, laser, np.array([5.0]))[1].refused == Refused.NOT


@pytest.mark.parametrize(
    "chosen", [{"kappa": -0.5}, {"alpha": 1e-3, "beta": 2.0, "kappa": 0.0}, {"alpha": 0.3}]
)
def test_negative_weights_keep_a_covariance(chosen):
    filter = UKF(**chosen)
    random = np.random.default_rng(5)
    belief = Gaussian(
        np.array([[5.0, 4.0, 0.3]] * 20), np.tile(np.diag([0.04, 0.04, 0.3]), (20, 1, 1))
    )
    for step in range(50):
        belief, _ = filter.predict(belief, MoveTurn(0.1, 0.1), random.uniform(-0.3, 0.3, (20, 2)))
        if step % 5 == 4:
            belief, _ = filter.update(belief, landmark(6.0, 5.0, 0.3, 0.1), np.array([[1.0, 0.3]]))
        assert definite(belief.covariance, 1e-9)


def test_where_nothing_bends_the_points_do_not_matter():
    random = np.random.default_rng(6)
    model = problem(random, 3, 2, 2)
    prior, z = Gaussian(random.normal(size=3), covariance(random, 3)), random.normal(size=2)
    results = [
        UKF(headings=(), alpha=a, kappa=k).update(prior, model, z)[0]
        for a, k in ((1, 0), (1, 2), (0.3, 0))
    ]
    for other in results[1:]:
        assert other.mean == pytest.approx(results[0].mean, abs=1e-10)
        assert close(np.round(other.covariance, 10), np.round(results[0].covariance, 10))


@pytest.mark.parametrize("heading", [0.0, math.pi - 0.01, -math.pi + 0.01])
@pytest.mark.parametrize("degrees", [60, 90, 120, 180, 270, 360, 1000])
def test_standing_still_forgets_no_doubt_of_the_heading(degrees, heading):
    """Of σ 120° it made 60°, of 180° none: differences of sigma points were wrapped."""
    σ = np.array([0.5, 0.2, math.radians(degrees)])
    P = np.array([[1, 0.3, -0.5], [0.3, 1, 0.4], [-0.5, 0.4, 1]]) * np.outer(σ, σ)
    belief, prediction = UKF().predict(
        Gaussian(np.array([1.0, 2.0, heading]), P), MoveTurn(0.1, 0.1), np.zeros(2)
    )
    assert belief.mean == pytest.approx([1.0, 2.0, heading], abs=1e-12)
    np.testing.assert_allclose(belief.covariance, P, rtol=1e-12)
    np.testing.assert_allclose(prediction.F, np.eye(3), atol=1e-9)
    turned, _ = UKF().predict(
        Gaussian(np.array([1.0, 2.0, heading]), P), MoveTurn(0.0, 0.0), np.array([0.0, 2.0])
    )
    assert math.remainder(turned.mean[2] - heading - 2.0, 2 * math.pi) == pytest.approx(
        0, abs=1e-12
    )
    np.testing.assert_allclose(turned.covariance, P, rtol=1e-12)


@pytest.mark.parametrize("degrees", [20, 100, 150, 360])
@pytest.mark.parametrize("heading", [0.3, 3.1, -3.1])
def test_a_bearing_is_read_with_a_heading_of_any_doubt(degrees, heading):
    """The place is known, so all is linear in the heading: the Kalman filter's answer, whatever its
    σ."""
    P = np.diag([0.0, 0.0, math.radians(degrees) ** 2])
    prior, sensor = Gaussian(np.array([0.0, 0.0, heading]), P), landmark(3.0, 1.0)
    z = sensor.h(prior.mean) + np.array([0.02, 0.4])
    right, told = EKF().update(prior, sensor, z)
    posterior, correction = UKF().update(prior, sensor, z)
    assert posterior.mean == pytest.approx(right.mean, abs=1e-12)
    np.testing.assert_allclose(posterior.covariance, right.covariance, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(correction.S, told.S, rtol=1e-12)


@pytest.mark.parametrize("system", ["gnss", "pioneer"])
@pytest.mark.parametrize("degrees", [90, 180, 360])
def test_an_unknown_heading_stays_unknown_until_something_is_read(system, degrees):
    """The first input in a driven system, before any reading, leaves the deviation of the heading
    about as it was."""
    made = load_scene(system)
    sigma = np.array([0.05, 0.05, math.radians(degrees)])
    told = replace(made.world.told, sigma=sigma)
    made = replace(made, filter="ukf", world=replace(made.world, told=told))
    for step in play(made):
        if step.correction is not None:
            break
        i = step.layout.headings[0]
        assert math.sqrt(step.posterior.covariance[i, i]) == pytest.approx(sigma[2], rel=0.02)


@pytest.mark.parametrize("name", ["ukf", "ukf-augmented"])
@pytest.mark.parametrize("degrees", [90, 135, 180, 270])
def test_fixes_tell_a_heading_that_nobody_knew(name, degrees):
    """Points further than half a turn told of the wrong side: of σ 90° and 270° all runs were lost,
    of 180° a third."""
    made = gnss(filter=name)
    σ = np.array([0.05, 0.05, math.radians(degrees)])
    world = replace(made.world, start_sigma=σ, told=replace(made.world.told, sigma=σ))
    course = replace(made, world=world, drive=Circle(2.0, 1.0, 0.5))  # half a lap is enough
    *_, last = play(course, np.arange(24))
    limit = np.array([quantile(0.999, int(dof)) for dof in last.nees.dof])
    assert np.mean(last.nees.value > limit) <= 1 / 24
    assert not last.nees.impossible.any()


@pytest.mark.parametrize("spread", [0.5, 1.7, 4.0])
def test_no_point_lies_further_than_a_quarter_of_a_turn(spread):
    random = np.random.default_rng(3)
    L = square_root(covariance(random, 50, 4) * 10.0 ** random.uniform(-4, 3, (50, 1, 1)))
    far = reach(L, spread, (1, 3))
    turns = np.abs(far[..., None, :] * L)[:, [1, 3]].max(axis=1)
    assert (turns <= math.pi / 2 + 1e-12).all()
    assert (far <= spread).all()
    np.testing.assert_allclose(far[turns < math.pi / 2 - 1e-9], spread)
    assert np.array_equal(reach(L, spread, ()), np.full((50, 4), spread))


@pytest.mark.parametrize("degrees", [30, 150, 360])
def test_a_heading_that_is_measured_anew_is_known_whatever_it_was(degrees):
    """The cart of document 004 takes its yaw from the input: what it was goes to theta_prev, with
    all its doubt."""
    cart = load_scene("pylon")
    steps = play(replace(cart, filter="ekf"))
    motion, u = next(
        (s.entry.given.motion, s.entry.given.u) for s in steps if s.prediction is not None
    )
    n, (θ, before) = len(cart.world.layout.names), cart.world.layout.headings
    P = 1e-4 * np.eye(n)
    P[θ, θ] = math.radians(degrees) ** 2
    x = np.zeros(n)
    right, _ = EKF(headings=(θ, before)).predict(Gaussian(x, P), motion, u)
    belief, _ = UKF(headings=(θ, before)).predict(Gaussian(x, P), motion, u)
    assert belief.covariance[θ, θ] == pytest.approx(right.covariance[θ, θ], rel=1e-6)
    assert belief.covariance[before, before] == pytest.approx(P[θ, θ], rel=1e-6)
