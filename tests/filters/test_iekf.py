import math
from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numerics import covariance, definite
from problems import ROOM, classroom, landmark, problem
from scipy.optimize import least_squares
from scipy.stats import chi2

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.ekf import EKF
from ekfsim.filters.iekf import IEKF
from ekfsim.localization import first_belief, localize, play
from ekfsim.models.protocols import Quantity
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.simulation import simulate

seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize(("n", "k"), [(3, 1), (3, 2), (4, 3), (7, 2)])
@given(seeds)
def test_a_linear_problem_is_left_as_it_is(n, k, seed):
    random = np.random.default_rng(seed)
    model = replace(problem(random, n, 2, k), noise=0.1 * np.eye(k))
    prior = Gaussian(random.normal(size=n), covariance(random, n) / n)
    z = model.C @ prior.mean + random.normal(size=k)
    mean, P = EKF(headings=()).update(prior, model, z)[0]
    posterior, _ = IEKF(headings=()).update(prior, model, z)
    assert posterior.mean == pytest.approx(mean, rel=1e-12, abs=1e-12 * max(1, np.abs(mean).max()))
    assert posterior.covariance == pytest.approx(P, rel=1e-12, abs=1e-12 * max(1, np.abs(P).max()))


class Square:
    """z = x², the textbook's example."""

    outputs = (Quantity("z", "m"),)

    def linearize(self, x):
        return x * x, 2 * x[..., None], np.array([[0.01]])

    def residual(self, z, h):
        return z - h


def test_one_number_and_its_square():
    """Gauss–Newton by hand: xᵢ₊₁ = x⁻ + Kᵢ (z − xᵢ² − 2xᵢ (x⁻ − xᵢ)), and the most probable x is a
    root of a cubic."""
    x0, P, R, z = 2.0, 0.5, 0.01, 6.0
    x = x0
    for n in range(1, 60):
        posterior, correction = IEKF(headings=(), iterations=n).update(
            Gaussian(np.array([x0]), np.array([[P]])), Square(), np.array([z])
        )
        H = 2 * x
        K = P * H / (H * P * H + R)
        x = x0 + K * (z - x * x - H * (x0 - x))
        assert posterior.mean[0] == pytest.approx(x, rel=1e-9)
        assert correction.innovation == z - x0 * x0
        assert pytest.approx(4 * x0 * x0 * P + R) == correction.S
        assert correction.settled == (n > 4)
    roots = np.roots([2 / R, 0, 1 / P - 2 * z / R, -x0 / P])
    assert x == pytest.approx(min(roots.real, key=lambda root: abs(root - x)), rel=1e-12)
    assert correction.H[0, 0] == pytest.approx(2 * x, rel=1e-6)


@pytest.mark.parametrize("axes", [(), (1,)])
def test_no_step_leads_up(axes):
    """From 0.3 the first step would go to 6.6, far beyond √4: each cap ends no higher than the one
    before."""
    prior = Gaussian(np.full((*axes, 1), 0.3), np.full((*axes, 1, 1), 25.0))
    J = lambda x: (x - 0.3) ** 2 / 25 + (4 - x * x) ** 2 / 0.01  # noqa: E731
    once = EKF(headings=()).update(prior, Square(), np.full((*axes, 1), 4.0))[0].mean.item()
    assert J(once) > J(0.3)
    costs = [J(0.3)]
    for n in range(1, 40):
        posterior, correction = IEKF(headings=(), iterations=n).update(
            prior, Square(), np.full((*axes, 1), 4.0)
        )
        costs.append(J(posterior.mean.item()))
    assert (np.diff(costs) <= 1e-9).all()
    assert np.all(correction.settled)
    assert posterior.mean.item() == pytest.approx(2.0, abs=0.01)


@given(seeds)
def test_it_finds_the_most_probable_place(seed):
    """As scipy's least squares do: (x − x⁻)ᵀ P⁻¹ (x − x⁻) + νᵀ R⁻¹ ν is least."""
    random = np.random.default_rng(seed)
    prior = Gaussian(
        np.array([0.0, 0.0, random.uniform(-3, 3)]), 0.01 * covariance(random, 3) + 0.02 * np.eye(3)
    )
    mark = landmark(2.0, 1.5, 0.1, 0.05)
    z = mark.h(random.multivariate_normal(*prior)) + random.normal(size=2) * (0.1, 0.05)
    posterior, correction = IEKF(iterations=50).update(prior, mark, z)
    root_P, root_R = (
        np.linalg.inv(np.linalg.cholesky(C)) for C in (prior.covariance, correction.R)
    )
    best = least_squares(
        lambda x: np.concatenate([root_P @ (x - prior.mean), root_R @ mark.residual(z, mark.h(x))]),
        prior.mean, xtol=1e-14, ftol=1e-14, gtol=1e-14,
    ).x  # fmt: skip
    off = posterior.mean - best
    assert [*off[:2], math.remainder(off[2], 2 * math.pi)] == pytest.approx([0, 0, 0], abs=1e-6)
    K, H = correction.K, correction.H
    assert posterior.covariance == pytest.approx((np.eye(3) - K @ H) @ prior.covariance, abs=1e-10)
    assert definite(posterior.covariance)


def test_no_iteration_is_the_ekf():
    for seed in range(20):
        prior, laser, _ = classroom(np.random.default_rng(seed))
        z = laser.h(prior.mean) * 1.03
        mean, P = EKF().update(prior, laser, z)[0]
        posterior, _ = IEKF(iterations=0).update(prior, laser, z)
        assert posterior.mean == pytest.approx(mean, abs=1e-12)
        assert posterior.covariance == pytest.approx(P, abs=1e-12)


def test_no_step_leads_to_where_nothing_would_be_seen():
    """The reading says 2 m less: where the EKF goes to, the beam passes the post, and no reading
    would have come."""
    post = Walls.of({"post": np.array([[5, -0.2], [5.4, -0.2], [5.4, 0.2], [5, 0.2]])})
    P = np.array([[1.0, 0.3, 0], [0.3, 0.2, 0], [0, 0, 1e-4]])
    prior, laser = Gaussian(np.zeros(3), P), Laser(post, 0.0, 0.01)
    once = EKF().update(prior, laser, np.array([3.0]))[0]
    assert np.isnan(laser.h(once.mean)).all()
    posterior, correction = IEKF().update(prior, laser, np.array([3.0]))
    assert correction.refused == Refused.NOT
    assert 4 < laser.h(posterior.mean)[0] < 5
    assert definite(posterior.covariance)


def test_what_a_reading_is_judged_by_is_the_prediction():
    prior, laser, _ = classroom(np.random.default_rng(1))
    z = laser.h(prior.mean) * 1.1
    _, first = EKF().update(prior, laser, z)
    _, told = IEKF().update(prior, laser, z)
    assert told.nis == pytest.approx(first.nis, rel=1e-12)
    assert pytest.approx(first.S, rel=1e-12) == told.S
    gate = 0.5
    assert IEKF(gate).update(prior, Laser(ROOM, 0.1, 0.0), z + 3)[1].refused == Refused.GATE


def test_where_the_search_is_cut_off_does_not_matter():
    """Among walls it cycled, and what its tenth point was decided whether the robot is lost: 28 to
    40 % by the cap."""
    scene, runs = load_scene("diverge-01-wrong-wall"), np.arange(256)
    shares = []
    for cap in (8, 50):
        entries, belief = simulate(scene, runs), first_belief(scene, runs.shape)
        *_, last = localize(entries, IEKF(iterations=cap), belief, scene.guard)
        lost = last.nees.impossible | (np.nan_to_num(last.nees.value) > chi2.ppf(0.999, 3))
        shares.append(lost.mean())
    assert max(shares) - min(shares) <= 0.005 + 1e-12


def test_a_run_among_walls_is_the_same_alone_as_among_others():
    """The cut-off search magnified rounding to 10⁻⁷ m in run 7 of this scene."""
    scene = replace(load_scene("diverge-01-wrong-wall"), filter="iekf")
    many = play(scene, np.arange(16))
    for one, all_runs in zip(play(replace(scene, run=7)), many, strict=True):
        assert all_runs.posterior.mean[7] == pytest.approx(one.posterior.mean, abs=1e-9)
        assert all_runs.posterior.covariance[7] == pytest.approx(one.posterior.covariance, abs=1e-9)


class Counted(Laser):
    """A laser that counts how often it is looked along."""

    __slots__ = ()
    looks: ClassVar[list[int]] = []

    def linearize(self, x):
        self.looks.append(len(x))
        return super().linearize(x)


@pytest.mark.parametrize("most", [8, 50])
def test_a_bent_valley_is_not_walked_to_its_end(most):
    """A beam of a millimetre and a belief wider than the room, all of it correlated: many short
    steps lead down."""
    random = np.random.default_rng(1)
    x = np.column_stack([random.uniform(1, 9, (64, 2)), random.uniform(-np.pi, np.pi, 64)])
    root = random.normal(size=(64, 3, 3))
    P = root @ root.mT
    laser = Counted(ROOM, 0.3, 1e-4)
    laser.looks.clear()
    _, correction = IEKF(iterations=most).update(
        Gaussian(x, P), laser, random.uniform(1, 5, (64, 1))
    )
    assert len(laser.looks) <= 8 * most + 2
    if most == 8:
        assert not correction.settled.all()
