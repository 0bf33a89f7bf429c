"""The filter of several hypotheses, against EKFs, closed forms and a dense posterior."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from ekfsim.filters.belief import Gaussian, Mixture
from ekfsim.filters.ekf import EKF
from ekfsim.filters.mixture.merging import moments, reduced
from ekfsim.filters.mixture.mhekf import MHEKF
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.landmarks import RangeBearing
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.which_wall import scattered
from ekfsim.raycast.walls import Walls

ROOM = Walls.of({"boundary": np.array([[0, 0], [10, 0], [10, 8], [0, 8]], float)})
# a step in the wall ahead: 4 m from x = 0 where y < 0, 6 m where y > 0
STEP = Walls.of({}, {"near": np.array([[4.0, -9], [4, 0]]), "far": np.array([[6.0, 0], [6, 9]])})


def same(a: Mixture, b: Gaussian) -> None:
    assert_array_equal(a.mean, b.mean)
    assert_array_equal(a.covariance, b.covariance)


@pytest.mark.parametrize("runs", [(), (5,), (70,)])
def test_one_hypothesis_that_sees_one_wall_is_the_ekf_bit_for_bit(runs):
    x = np.broadcast_to(np.array([3.0, 2.0, 3.1]), (*runs, 3)).copy()
    x[..., 0] += np.arange(math.prod(runs)).reshape(runs) * 1e-3
    belief = Gaussian(x, np.broadcast_to(np.diag([0.01, 0.02, 0.001]), (*runs, 3, 3)))
    motion, u = MoveTurn(0.05, 0.02), np.broadcast_to(np.array([0.3, 0.1]), (*runs, 2))
    laser, z = Laser(ROOM, 0.2, 0.02), np.full((*runs, 1), 3.0)
    ekf, mhekf = EKF(), MHEKF()
    one, _ = ekf.predict(belief, motion, u)
    other, _ = mhekf.predict(belief, motion, u)
    same(other, one)
    one, told = ekf.update(one, laser, z)
    other, told_too = mhekf.update(other, laser, z)
    same(other, one)
    assert_array_equal(told.nis, told_too.nis)
    assert_array_equal(told.K, told_too.K)


def test_hypotheses_weigh_as_a_dense_posterior_has_them():
    """x and y are independent: y decides which wall is met, x what is read of it."""
    σ_x, σ_y, σ_z, y = 1.0, 0.3, 0.15, 0.12
    prior = Gaussian(np.array([0.0, y, 0.0]), np.diag([σ_x**2, σ_y**2, 0.0]))
    sharp = Laser(STEP, 0.0, σ_z / 6)  # of the far wall
    for z in (4.4, 5.0, 5.6):
        after, _ = MHEKF().update(prior, sharp, np.array([z]))
        gx, gy = np.meshgrid(np.linspace(-7, 7, 2801), np.linspace(y - 1.8, y + 1.8, 721))
        h = np.where(gy > 0, 6.0, 4.0) - gx
        σ = np.where(gy > 0, σ_z, σ_z * 4 / 6)  # C_v is that of the mean, (ratio · h)²
        density = np.exp(-0.5 * (gx / σ_x) ** 2 - 0.5 * ((gy - y) / σ_y) ** 2)
        density *= np.exp(-0.5 * ((z - h) / σ) ** 2) / σ
        density /= density.sum()
        far = float(density[gy > 0].sum())
        walls = dict(zip(after.walls.tolist(), after.weights.tolist(), strict=True))
        assert walls[1] == pytest.approx(far, abs=0.08)
        mean = float((density * gx).sum())
        assert float(after.mean[0]) == pytest.approx(mean, abs=0.2)
        deviation = math.sqrt(float((density * (gx - mean) ** 2).sum()))
        assert math.sqrt(float(after.covariance[0, 0])) == pytest.approx(deviation, rel=0.15)


def test_points_that_stand_for_a_gaussian_have_its_moments():
    points, weights = scattered()
    assert weights.sum() == pytest.approx(1)
    assert_allclose(weights @ points, 0, atol=1e-12)
    assert_allclose((points.T * weights) @ points, np.eye(3), atol=1e-12)


def test_merging_keeps_mean_and_covariance_across_the_seam():
    """Two of weights ¾ and ¼, 0.4 apart in x and 0.2 across ±π: mean at a quarter of the way."""
    means = np.array([[1.0, 2.0, math.pi - 0.05], [1.4, 2.0, -math.pi + 0.15]])
    P = np.stack([np.diag([0.04, 0.01, 0.03])] * 2)
    w = np.array([0.75, 0.25])
    few = reduced(means, 9 * P, w, 8, (2,))
    assert few.merged.tolist() == [2]
    assert few.weights.tolist() == [1.0]
    both = moments(means, 9 * P, w, (2,))
    x, S = few.means[0], few.covariances[0]
    assert_allclose(x[:2], [1.1, 2.0], rtol=1e-14)
    angle = math.atan2(0.25 * math.sin(0.2), 0.75 + 0.25 * math.cos(0.2))
    assert float(x[2]) == pytest.approx(math.pi - 0.05 + angle, abs=1e-12)
    assert float(S[0, 0]) == pytest.approx(0.36 + 0.75 * 0.25 * 0.4**2, abs=1e-12)
    spread = 0.75 * angle**2 + 0.25 * (0.2 - angle) ** 2
    assert float(S[2, 2]) == pytest.approx(0.27 + spread, abs=1e-12)
    assert_allclose(both.mean, x, rtol=1e-14)
    assert_allclose(both.covariance, S, rtol=1e-12)


def test_what_is_far_is_not_merged_and_the_lightest_go():
    means = np.array([[0.0, 0, 0], [5.0, 0, 0], [9.0, 0, 0], [14.0, 0, 0]])
    P = np.stack([np.diag([0.1, 0.1, 0.1])] * 4)
    few = reduced(means, P, np.array([0.1, 0.5, 0.3, 0.1]), 2, (2,))
    assert_allclose(few.weights, [0.625, 0.375])
    assert few.heaviest.tolist() == [1, 2]
    assert int(few.pruned) == 2


def test_certainty_does_not_merge_what_is_apart():
    """P = 0 in y: hypotheses that differ there alone are two."""
    means = np.array([[0.0, 0, 0], [0.0, 0.01, 0]])
    few = reduced(means, np.stack([np.diag([1.0, 0, 0])] * 2), np.array([0.6, 0.4]), 8, (2,))
    assert few.merged.tolist() == [1, 1]


@pytest.fixture
def parted() -> Mixture:
    prior = Gaussian(np.array([0.0, 0.05, 0.0]), np.diag([1.0, 0.09, 1e-4]))
    after, _ = MHEKF().update(prior, Laser(STEP, 0.0, 0.03), np.array([5.0]))
    assert np.count_nonzero(after.weights) == 2
    return after


@pytest.mark.parametrize(
    ("z", "skip", "gate"), [(math.nan, False, None), (5.0, True, None), (40.0, False, 0.99)]
)
def test_readings_that_are_refused_leave_hypotheses_and_weights_alone(parted, z, skip, gate):
    belief = parted
    for _ in range(10):
        belief, told = MHEKF(gate).update(belief, Laser(STEP, 0.0, 0.03), np.array([z]), skip)
        assert told.refused
    assert_array_equal(belief.weights[:2], parted.weights)
    assert_array_equal(belief.means[:2], parted.means)
    assert_array_equal(belief.covariances[:2], parted.covariances)


def test_an_impossible_reading_does_not_make_all_equal(parted):
    """Both densities are 0 as numbers; their logarithms still differ."""
    after, told = MHEKF().update(parted, Laser(STEP, 0.0, 1e-4), np.array([90.0]))
    assert float(told.nis) > 1500  # exp(−750) is 0
    assert float(after.weights.max()) > 0.999


def test_weights_of_readings_that_are_of_one_kind_are_those_of_bayes(parted):
    """A landmark's range and bearing has no other wall: w ∝ w N(ν; 0, S)."""
    sensor = RangeBearing(5.0, 3.0, 0.5, 0.2)
    z = sensor.h(parted.means[0]) + np.array([0.3, 0.1])
    after, _ = MHEKF().update(parted, sensor, z)
    likely = []
    for x, P in zip(parted.means, parted.covariances, strict=True):
        H, ν = sensor.H(x), sensor.residual(z, sensor.h(x))
        S = H @ P @ H.T + sensor.R(x)
        likely.append(math.exp(-0.5 * ν @ np.linalg.solve(S, ν)) / math.sqrt(np.linalg.det(S)))
    w = parted.weights * likely
    assert_allclose(np.sort(after.weights[:2]), np.sort(w / w.sum()), rtol=1e-9)


def test_runs_side_by_side_are_those_alone():
    rng = np.random.default_rng(5)
    x = np.array([0.0, 0.0, 0.0]) + rng.normal(0, [0.3, 0.3, 0.02], (6, 3))
    P = np.broadcast_to(np.diag([1.0, 0.09, 1e-4]), (6, 3, 3))
    motion, laser = MoveTurn(0.05, 0.02), Laser(STEP, 0.0, 0.03)
    u, zs = np.array([0.2, 0.05]), rng.uniform(4, 6, (3, 6, 1))
    zs[1, 2] = math.nan
    filter, many = MHEKF(hypotheses=3), Gaussian(x, P)
    alone = [Gaussian(x[i], P[i]) for i in range(6)]
    for z in zs:
        many, _ = filter.update(filter.predict(many, motion, np.tile(u, (6, 1)))[0], laser, z)
        for i in range(6):
            alone[i], _ = filter.update(filter.predict(alone[i], motion, u)[0], laser, z[i])
    for i, one in enumerate(alone):
        h = one.weights.shape[-1]
        assert_allclose(many.mean[i], one.mean, atol=1e-9)
        assert_allclose(many.covariance[i], one.covariance, atol=1e-9)
        assert_allclose(many.weights[i, :h], one.weights, atol=1e-9)
        assert not many.weights[i, h:].any()
