import math
from dataclasses import replace

import numpy as np
import pytest
from problems import begun, classroom, landmark

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.kf import KF
from ekfsim.filters.variants.nominal import NominalKF
from ekfsim.models.motions.move_turn import MoveTurn

PLAN = np.array([[1.0, 1.0, 0.2], [2.0, 1.2, 1.3], [2.3, 2.1, 3.1]])
FIRST = Gaussian(np.array([1.2, 0.9, 0.1]), np.diag([0.04, 0.02, 0.01]))
MOTION, MARK = MoveTurn(0.05, 0.1), landmark(4.0, 3.0)


def same(belief, other):
    np.testing.assert_array_equal(belief.mean, other.mean)
    np.testing.assert_array_equal(belief.covariance, other.covariance)


def test_it_is_the_kalman_filter_about_the_plan_of_the_moment():
    """The plan goes on with every motion input, with no reading, and stays at its end."""
    filter, belief, other = NominalKF(PLAN), FIRST, FIRST
    for x in (*PLAN, PLAN[-1], PLAN[-1]):
        there, z, u = KF(x), MARK.h(x) + 0.05, np.array([0.7, 0.9])
        for _ in range(2):
            belief, told = filter.update(belief, MARK, z)
            other, correction = there.update(other, MARK, z)
            same(belief, other)
            np.testing.assert_array_equal(told.H, MARK.linearize(x)[1])
            np.testing.assert_array_equal(told.K, correction.K)
        belief, prediction = filter.predict(belief, MOTION, u)
        other, _ = there.predict(other, MOTION, u)
        same(belief, other)
        np.testing.assert_array_equal(prediction.F, MOTION.F(x, u))


def test_on_its_plan_it_is_the_ekf():
    on_plan = Gaussian(PLAN[0], FIRST.covariance)
    z, u = MARK.h(PLAN[0]) + 0.02, np.array([1.0, 0.5])
    same(NominalKF(PLAN).update(on_plan, MARK, z)[0], EKF().update(on_plan, MARK, z)[0])
    same(NominalKF(PLAN).predict(on_plan, MOTION, u)[0], EKF().predict(on_plan, MOTION, u)[0])


def test_a_wrong_estimate_leaves_the_gain_as_it_is():
    """Which is what the EKF's cannot: its H is that of the estimate."""
    gains = [
        [filter.update(replace_mean(error), MARK, MARK.h(PLAN[0]))[1].K for error in (0.0, 1.0)]
        for filter in (NominalKF(PLAN), EKF())
    ]
    np.testing.assert_array_equal(*gains[0])
    assert np.abs(gains[1][0] - gains[1][1]).max() > 0.1


def replace_mean(error):
    return FIRST._replace(mean=PLAN[0] + (0, error, 0))


def test_headings_of_plan_and_estimate_may_lie_on_either_side_of_the_turn():
    plan, u = np.array([[0.0, 0.0, math.pi - 0.01]]), np.array([1.0, 0.0])
    belief, _ = NominalKF(plan).predict(
        Gaussian(np.array([0.0, 0.0, -math.pi + 0.01]), FIRST.covariance), MOTION, u
    )
    assert belief.mean == pytest.approx([-1.0, -0.01, -math.pi + 0.01], abs=1e-3)


def test_a_belief_and_its_filter_are_left_as_they_were():
    first, laser, motion = classroom(np.random.default_rng(3))
    filter = begun("kf-nominal", first)
    moved, _ = filter.predict(first, motion, np.array([0.3, 0.2]))
    again, _ = filter.predict(first, motion, np.array([0.3, 0.2]))
    assert moved.inputs == again.inputs == 1
    assert filter.update(moved, laser, laser.h(first.mean))[0].inputs == 1
    assert replace(filter) == filter
