import math
from dataclasses import replace
from datetime import datetime, timedelta

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter, KalmanFilter
from hypothesis import given
from hypothesis import strategies as st
from numerics import covariance, definite
from problems import close, problem, theirs
from scenes import rich, scene
from scipy.stats import chi2
from stonesoup.base import Property
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.models.transition.linear import LinearGaussianTimeInvariantTransitionModel
from stonesoup.predictor.kalman import ExtendedKalmanPredictor
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState
from stonesoup.updater.kalman import ExtendedKalmanUpdater

from ekfsim.commands import Move, Sense
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.ekf import EKF
from ekfsim.localization import play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.records import Control, Reading

seeds = st.integers(0, 2**32 - 1)
LINEAR = EKF(headings=())


@pytest.mark.parametrize("k", [1, 2])
@given(seeds)
def test_it_is_the_kalman_filter_where_all_is_linear(k, seed):
    random = np.random.default_rng(seed)
    model = problem(random, k=k)
    belief = Gaussian(random.normal(size=3), covariance(random, 3))
    other = theirs(KalmanFilter, model, *belief)
    u, z = random.normal(size=2), random.normal(size=k)
    belief, _ = LINEAR.predict(belief, model, u)
    other.predict(u)
    assert close(belief.mean, other.x)
    assert close(belief.covariance, other.P)
    belief, correction = LINEAR.update(belief, model, z)
    other.update(z)
    assert close(correction.S, other.S)
    assert belief.mean == pytest.approx(other.x, rel=1e-9, abs=1e-9)
    assert belief.covariance == pytest.approx(other.P, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("k", [1, 2])
@given(seeds)
def test_an_update_is_that_of_filterpy(k, seed):
    random = np.random.default_rng(seed)
    model = problem(random, k=k)
    prior = Gaussian(random.normal(size=3), covariance(random, 3) + 0.1 * np.eye(3))
    z = random.normal(size=k)
    other = theirs(ExtendedKalmanFilter, model, *prior)
    other.update(z, lambda x: model.C, model.h)
    posterior, correction = LINEAR.update(prior, model, z)
    assert close(correction.innovation, other.y)
    assert close(correction.S, other.S)
    assert close(correction.K, other.K)
    assert close(posterior.mean, other.x)
    assert close(posterior.covariance, other.P)
    assert correction.nis == pytest.approx(float(other.mahalanobis) ** 2, rel=1e-9)
    assert correction.refused == Refused.NOT


def classroom(random):
    prior = Gaussian(
        random.uniform((1, 1, -3), (9, 7, 3)), 0.01 * covariance(random, 3) + 1e-4 * np.eye(3)
    )
    room = Walls.of({"boundary": np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])})
    return prior, Laser(room, random.uniform(-3, 3), 0.02), MoveTurn(0.05, 0.1)


@given(seeds)
def test_the_classroom_is_filtered_as_filterpy_does(seed):
    random = np.random.default_rng(seed)
    belief, laser, motion = classroom(random)
    u = np.array([random.uniform(-0.5, 0.5), random.uniform(-1, 1)])
    other = ExtendedKalmanFilter(dim_x=3, dim_z=1)
    other.x, other.P = belief.mean.copy(), belief.covariance.copy()
    other.F, other.Q = (
        motion.F(*belief[:1], u),
        motion.G(*belief[:1], u) @ motion.M(u) @ motion.G(*belief[:1], u).T,
    )
    other.predict_x = lambda _: setattr(other, "x", motion.f(other.x, u))
    other.predict()
    belief, _ = EKF().predict(belief, motion, u)
    assert close(belief.mean, other.x)
    assert close(belief.covariance, other.P)
    z = laser.h(belief.mean) * random.uniform(0.9, 1.1)
    _, H, R = laser.linearize(belief.mean)
    other.update(z, lambda x: H, laser.h, R=R)
    posterior, correction = EKF().update(belief, laser, z)
    assert close(correction.K, other.K)
    assert close(posterior.mean[:2], other.x[:2])
    assert math.remainder(posterior.mean[2] - other.x[2], 2 * math.pi) == pytest.approx(
        0, abs=1e-12
    )
    assert close(posterior.covariance, other.P)


@given(seeds)
def test_the_covariance_is_that_of_the_assignment(seed):
    """Equation 12, (I − KH) P, is Joseph's form for the optimal gain."""
    random = np.random.default_rng(seed)
    prior, laser, _ = classroom(random)
    posterior, correction = EKF().update(prior, laser, laser.h(prior.mean) + 0.01)
    assert posterior.covariance == pytest.approx(
        (np.eye(3) - correction.K @ correction.H) @ prior.covariance, abs=1e-13
    )
    assert definite(posterior.covariance)
    assert np.trace(posterior.covariance) <= np.trace(prior.covariance)


@pytest.mark.parametrize("axes", [(1,), (5,), (3, 2)])
@pytest.mark.parametrize("gate", [None, 0.5])
def test_a_batch_equals_its_runs(axes, gate):
    random = np.random.default_rng(7)
    _, laser, motion = classroom(random)
    x, P = random.uniform((-2, 1, -3), (9, 7, 3), (*axes, 3)), 0.01 * covariance(random, *axes, 3)
    P[..., 2, :] = P[..., :, 2] = 0
    u, z = random.uniform(-1, 1, (*axes, 2)), laser.h(x) * random.uniform(0.9, 1.1, (*axes, 1))
    z.flat[0] = np.nan
    skip = random.random(axes) < 0.3
    filter = EKF(gate)
    predicted, prediction = filter.predict(Gaussian(x, P), motion, u)
    updated, correction = filter.update(Gaussian(x, P), laser, z, skip)
    for k in np.ndindex(axes):
        one, one_prediction = filter.predict(Gaussian(x[k], P[k]), motion, u[k])
        same(predicted, one, k)
        for name in ("F", "G"):
            assert getattr(prediction, name)[k] == pytest.approx(
                getattr(one_prediction, name), abs=1e-12
            )
        one, one_correction = filter.update(Gaussian(x[k], P[k]), laser, z[k], skip[k])
        same(updated, one, k)
        for name in ("predicted", "innovation", "R", "S", "H", "K", "nis", "refused"):
            batch, alone = getattr(correction, name), np.asarray(getattr(one_correction, name))
            assert batch.shape == (*axes, *alone.shape)
            assert batch[k] == pytest.approx(alone, rel=1e-12, abs=1e-12, nan_ok=True)


def same(batch, one, k):
    assert batch.mean[k] == pytest.approx(one.mean, abs=1e-12)
    assert batch.covariance[k] == pytest.approx(one.covariance, abs=1e-12)


def reading(
    z,
    x=(3.0, 4.0, 0.1),
    P=np.diag([0.01, 0.02, 0.003]),  # noqa: B008
    ratio=0.01,
    gate=None,
    skip=False,
    walls=None,
):
    room = Walls.of(
        {"boundary": np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])} if walls is None else walls
    )
    prior, laser = Gaussian(np.array(x, float), np.array(P, float)), Laser(room, 0.0, ratio)
    ((posterior, correction), (batch, corrections)) = (
        EKF(gate).update(prior, laser, np.array([z], float), skip),
        EKF(gate).update(
            Gaussian(prior.mean[None], prior.covariance[None]), laser, np.array([[z]], float), skip
        ),
    )
    same(batch, posterior, 0)
    assert corrections.refused[0] == correction.refused
    assert corrections.nis[0] == pytest.approx(float(correction.nis), nan_ok=True)
    assert corrections.K[0] == pytest.approx(correction.K, rel=1e-12)
    return prior, posterior, correction


def untouched(prior, posterior, correction):
    assert (posterior.mean == prior.mean).all()
    assert (posterior.covariance == prior.covariance).all()
    if not np.isnan(correction.S).any():  # what the reading would have done is told all the same
        would = prior.covariance @ correction.H.mT @ np.linalg.pinv(correction.S)
        np.testing.assert_allclose(correction.K, would, rtol=1e-9, atol=1e-15)
    return True


def test_a_reading_as_predicted_moves_nothing_but_narrows():
    prior, posterior, correction = reading(7 / math.cos(0.1))
    assert posterior.mean == pytest.approx(prior.mean, abs=1e-12)
    assert np.trace(posterior.covariance) < np.trace(prior.covariance)
    assert correction.nis == pytest.approx(0, abs=1e-12)


def test_no_echo():
    prior, posterior, correction = reading(np.nan)
    assert untouched(prior, posterior, correction)
    assert correction.refused == Refused.NO_ECHO
    assert np.isnan(correction.nis)


@pytest.mark.parametrize("walls", [{}, {"post": np.array([[1, 1], [2, 1], [2, 2.0]])}])
def test_no_wall(walls):
    prior, posterior, correction = reading(5.0, walls=walls)
    assert untouched(prior, posterior, correction)
    assert correction.refused == Refused.NO_WALL
    assert np.isnan(correction.nis)
    assert np.isnan(correction.S).all()
    assert reading(np.nan, walls=walls)[2].refused == Refused.NO_ECHO  # the first reason that holds


def test_the_guard_judges_but_does_not_use():
    prior, posterior, correction = reading(7.5, skip=True)
    assert untouched(prior, posterior, correction)
    assert correction.refused == Refused.GUARD
    assert correction.nis == reading(7.5)[2].nis > 0
    assert reading(20, skip=True, gate=0.5)[2].refused == Refused.GUARD


def test_the_gate_refuses_what_lies_beyond_its_quantile():
    _, _, correction = reading(7.2)
    h, deviation = correction.predicted[0], math.sqrt(correction.S[0, 0])
    limit = math.sqrt(chi2.ppf(0.99, 1)) * deviation
    for side in (-1, 1):
        assert reading(h + side * limit * 0.9999, gate=0.99)[2].refused == Refused.NOT
        prior, posterior, correction = reading(h + side * limit * 1.0001, gate=0.99)
        assert untouched(prior, posterior, correction)
        assert correction.refused == Refused.GATE
        assert correction.nis == pytest.approx(chi2.ppf(0.99, 1), rel=1e-3)


def test_the_gate_of_two_readings_at_once_has_two_degrees_of_freedom():
    random = np.random.default_rng(8)
    model = replace(problem(random, k=2), C=np.eye(2, 3), noise=np.eye(2))
    prior = Gaussian(np.zeros(3), np.zeros((3, 3)))
    for gate, limit in ((0.9, chi2.ppf(0.9, 2)), (0.99, chi2.ppf(0.99, 2))):
        for share, refused in ((0.999, Refused.NOT), (1.001, Refused.GATE)):
            z = np.array([math.sqrt(share * limit), 0.0])
            assert EKF(gate, headings=()).update(prior, model, z)[1].refused == refused


def test_where_nothing_is_uncertain_nothing_is_learnt():
    prior, posterior, correction = reading(5.0, P=np.zeros((3, 3)), ratio=0.0, gate=0.5)
    assert untouched(prior, posterior, correction)
    assert correction.S == 0
    assert np.isnan(correction.nis)
    assert correction.refused == Refused.NOT


def test_a_certain_belief_ignores_every_reading():
    prior, posterior, correction = reading(5.0, P=np.zeros((3, 3)))
    assert untouched(prior, posterior, correction)
    assert correction.nis == pytest.approx(
        (5 - 7 / math.cos(0.1)) ** 2 / (0.01 * 7 / math.cos(0.1)) ** 2
    )


def test_a_perfect_laser_leaves_no_doubt_along_its_beam():
    _, posterior, correction = reading(7.2, ratio=0.0)
    assert correction.H @ posterior.covariance @ correction.H.T == pytest.approx(0, abs=1e-15)
    assert definite(posterior.covariance)


@given(st.lists(st.booleans(), min_size=3, max_size=3), seeds)
def test_singular_covariances(alive, seed):
    random = np.random.default_rng(seed)
    P = np.zeros((3, 3))
    on = np.flatnonzero(alive)
    P[np.ix_(on, on)] = (
        0.01 * covariance(random, len(on), rank=max(1, len(on) - 1)) if len(on) else 0
    )
    prior, posterior, correction = reading(7.1, P=P)
    assert definite(posterior.covariance, 1e-9)
    assert (posterior.mean[~np.array(alive)] == prior.mean[~np.array(alive)]).all()
    assert np.isfinite(correction.K).all()


def test_two_readings_without_noise_of_a_certain_state():
    model = problem(np.random.default_rng(9), k=2)
    certain = replace(model, noise=np.zeros((2, 2)))
    prior = Gaussian(np.ones(3), np.zeros((3, 3)))
    posterior, correction = LINEAR.update(prior, certain, np.ones(2))
    assert untouched(prior, posterior, correction)
    assert np.isnan(correction.nis)
    posterior, correction = LINEAR.update(prior, certain, np.array([1.0, np.nan]))
    assert untouched(prior, posterior, correction)
    assert correction.refused == Refused.NO_ECHO


def test_an_innovation_that_is_an_angle_is_wrapped_by_its_sensor():
    model = replace(
        problem(np.random.default_rng(10)),
        C=np.array([[0, 0, 1.0]]),
        noise=np.array([[0.1]]),
        angles=(0,),
    )
    posterior, correction = EKF().update(
        Gaussian(np.array([0, 0, 3.1]), np.eye(3)), model, np.array([-3.1])
    )
    assert correction.innovation == pytest.approx(2 * math.pi - 6.2)
    assert -math.pi < posterior.mean[2] <= math.pi
    assert posterior.mean[2] == pytest.approx(3.1 + (2 * math.pi - 6.2) / 1.1 - 2 * math.pi)


@pytest.mark.parametrize("axes", [(), (2,)])
def test_headings_stay_within_half_a_turn(axes):
    motion, x = MoveTurn(0.1, 0.1), np.broadcast_to([0, 0, 3.0], (*axes, 3))
    belief, _ = EKF().predict(
        Gaussian(x, np.zeros((*axes, 3, 3))), motion, np.broadcast_to([1.0, 0.5], (*axes, 2))
    )
    assert belief.mean[..., 2] == pytest.approx(3.5 - 2 * math.pi)


@given(seeds)
def test_nothing_handed_in_is_changed(seed):
    prior, laser, motion = classroom(np.random.default_rng(seed))
    x, P, u, z = prior.mean.copy(), prior.covariance.copy(), np.array([1.0, 4.0]), np.array([6.0])
    for array in (prior.mean, prior.covariance, u, z):
        array.flags.writeable = False
    EKF().predict(prior, motion, u)
    EKF().update(prior, laser, z)
    assert (prior.mean == x).all()
    assert (prior.covariance == P).all()


@pytest.mark.parametrize("seed", range(4))
def test_a_long_run_stays_symmetric_definite_and_in_range(seed):
    random = np.random.default_rng(seed)
    course = [
        c
        for _ in range(250)
        for c in (Move(random.uniform(-1, 2), random.uniform(-3, 3)), Sense(random.uniform(-3, 3)))
    ]
    for step in play(scene(*course, seed=seed)):
        assert definite(step.posterior.covariance, 1e-10)
        assert -math.pi < step.posterior.mean[2] <= math.pi
        assert np.isfinite(step.posterior.mean).all()


def test_ratios_of_zero_keep_a_certain_belief_certain():
    motion, belief = MoveTurn(0.0, 0.0), Gaussian(np.array([1, 2, 0.5]), np.zeros((3, 3)))
    for u in ([1.0, 0.3], [0.0, 0.0], [-2.0, 0.0]):
        belief, _ = EKF().predict(belief, motion, np.array(u))
        assert (belief.covariance == 0).all()


def test_standing_still_adds_no_doubt():
    P = covariance(np.random.default_rng(10), 3)
    belief, prediction = EKF().predict(Gaussian(np.zeros(3), P), MoveTurn(0.5, 0.5), np.zeros(2))
    assert belief.covariance == pytest.approx(P)
    assert np.array_equal(prediction.F, np.eye(3))


@pytest.mark.parametrize("name", FILTERS)
def test_every_filter_tells_the_same_story_alone_as_in_a_batch(name):
    course = replace(rich(gate=0.99, guard="skip"), filter=name)
    many = list(play(course, np.array([0, 3, 1500])))
    for row, run in enumerate((0, 3, 1500)):
        for one, batch in zip(play(replace(course, run=run)), many, strict=True):
            same(batch.posterior, one.posterior, row)
            if one.correction:
                assert batch.correction.refused[row] == one.correction.refused
            match one.entry.given, batch.entry.given:
                case Control(_, u), Control(_, us):
                    assert us[row] == pytest.approx(u, abs=1e-12)
                case Reading(_, z), Reading(_, zs):
                    assert zs[row] == pytest.approx(z, abs=1e-12, nan_ok=True)


def test_a_perfect_laser_settles_what_it_measures_once_and_for_all():
    """With a known heading all is linear: two beams tell the place exactly, and S is 0 ever after,
    not rounding."""
    room = Walls.of({"room": np.array([[0, 0], [8, 0], [8, 6], [0, 6.0]])})
    for seed in range(20):
        random = np.random.default_rng(seed)
        truth = np.array([3.0, 2.0, 0.0])
        P = covariance(random, 3) * 1e-4
        P[2] = P[:, 2] = 0
        belief = Gaussian(np.append(random.multivariate_normal(truth[:2], P[:2, :2]), 0.0), P)
        for n, bearing in enumerate((0.3, 0.3, 1.5, 0.3, 1.5, -1.2, 0.3)):
            laser = Laser(room, bearing, 0.0)
            z = laser.h(truth)
            alone, correction = EKF().update(belief, laser, z)
            batch, batched = EKF().update(
                Gaussian(belief.mean[None], belief.covariance[None]), laser, z[None]
            )
            same(batch, alone, 0)
            settled = n not in (0, 2)
            assert np.isnan(correction.nis) == np.isnan(batched.nis[0]) == settled
            belief = alone
        assert belief.mean == pytest.approx(truth, abs=1e-9)
        assert (belief.covariance == 0).all()


class Matrix(LinearGaussian):
    """Stone Soup's linear sensor with any H."""

    matrix_: np.ndarray = Property()

    def matrix(self, **kwargs):
        return self.matrix_


SIZES = [(3, 1), (3, 2), (3, 3), (4, 1), (4, 2), (4, 3), (7, 2), (7, 3)]


def random_problem(seed, n, k):
    random = np.random.default_rng(seed)
    model = problem(random, n, 2, k)
    prior = Gaussian(random.normal(size=n), covariance(random, n) / n + 0.1 * np.eye(n))
    return model, prior, random.normal(size=2), random.normal(size=k)


@pytest.mark.parametrize(("n", "k"), SIZES)
def test_states_and_readings_of_any_size_are_filtered_as_filterpy_does(n, k):
    for seed in range(20):
        model, belief, u, z = random_problem(seed, n, k)
        other = theirs(ExtendedKalmanFilter, model, *belief)
        other.predict_x = lambda _, other=other, model=model, u=u: setattr(
            other, "x", model.f(other.x, u)
        )
        other.predict()
        belief, _ = LINEAR.predict(belief, model, u)
        assert close(belief.mean, other.x)
        assert close(belief.covariance, other.P)
        other.x, other.P = belief.mean.copy(), belief.covariance.copy()
        other.update(z, lambda x, model=model: model.C, model.h)
        belief, correction = LINEAR.update(belief, model, z)
        assert close(correction.S, other.S)
        assert close(correction.K, other.K)
        assert close(belief.mean, other.x)
        assert close(belief.covariance, other.P)


@pytest.mark.parametrize(("n", "k"), SIZES)
def test_states_and_readings_of_any_size_are_filtered_as_stone_soup_does(n, k):
    now = datetime(2025, 1, 1)
    for seed in range(5):
        model, belief, _, z = random_problem(seed, n, k)
        W = model.B @ model.input_noise @ model.B.T + model.process_noise
        transition = LinearGaussianTimeInvariantTransitionModel(
            transition_matrix=model.A, covariance_matrix=W
        )
        state = GaussianState(belief.mean[:, None], belief.covariance, timestamp=now)
        prediction = ExtendedKalmanPredictor(transition).predict(
            state, timestamp=now + timedelta(seconds=1)
        )
        belief, _ = LINEAR.predict(belief, model, np.zeros(2))
        assert close(belief.mean, np.asarray(prediction.mean)[:, 0])
        assert close(belief.covariance, np.asarray(prediction.covar))
        updater = ExtendedKalmanUpdater(
            Matrix(n, np.arange(k), model.noise, matrix_=model.C), use_joseph_cov=True
        )
        updated = updater.update(SingleHypothesis(prediction, Detection(z[:, None], timestamp=now)))
        belief, correction = LINEAR.update(belief, model, z)
        assert close(correction.S, np.asarray(updated.hypothesis.measurement_prediction.covar))
        assert close(belief.mean, np.asarray(updated.mean)[:, 0])
        assert close(belief.covariance, np.asarray(updated.covar))


@pytest.mark.parametrize(("n", "k"), SIZES)
def test_a_sensor_of_a_micrometre(n, k):
    """R = 10⁻¹²: what was measured is known so well, and the rest as the prior has it."""
    for seed in range(20):
        model, prior, _, z = random_problem(seed, n, k)
        C = np.linalg.qr(model.C.T)[0].T
        sharp = replace(model, C=C, noise=1e-12 * np.eye(k))
        posterior, correction = LINEAR.update(prior, sharp, z)
        assert np.matvec(C, posterior.mean) == pytest.approx(z, abs=1e-9)
        assert C @ posterior.covariance @ C.T == pytest.approx(sharp.noise, abs=1e-14)
        assert definite(posterior.covariance)
        certain = Gaussian(prior.mean, np.zeros((n, n)))
        same_mean, correction = LINEAR.update(certain, sharp, np.matvec(C, prior.mean) + 1e-6)
        assert correction.nis == pytest.approx(k, rel=1e-6)
        assert (same_mean.mean == prior.mean).all()
