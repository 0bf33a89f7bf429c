import math

import numpy as np
import pytest

from ekfsim.models.motions.odometry import ArctanOdometry, SkidSteer
from ekfsim.models.motions.unicycle import Unicycle
from ekfsim.models.motions.wheels import TwoWheels

MODEL = ArctanOdometry(0.38, 0.05, 0.002)


def test_it_turns_first_and_drives_at_the_new_heading():
    x = MODEL.f(np.array([1.0, 2.0, 0.3]), np.array([0.1, 0.2]))
    ω = 0.3 + math.atan(0.1 / 0.38)
    assert x == pytest.approx([1 + 0.15 * math.cos(ω), 2 + 0.15 * math.sin(ω), ω])


def test_the_noise_grows_with_the_way_of_each_wheel():
    assert MODEL.M(np.array([-2.0, 0.0])) == pytest.approx(np.diag([0.1**2 + 0.002**2, 0.002**2]))
    assert not ArctanOdometry(0.38, 0.05).M(np.zeros(2)).any()


def test_small_turns_are_those_of_two_wheels():
    x, u = np.array([0.0, 0.0, 1.0]), np.array([0.0100, 0.0101])
    assert MODEL.f(x, u) == pytest.approx(TwoWheels(0.38, 0.002).f(x, u), abs=1e-5)


def test_a_skid_steered_robot_that_does_not_slip_is_a_unicycle():
    W = 0.4
    robot = SkidSteer(((0.5, 0.5), (0.0, 0.0), (1 / W, -1 / W)), 0.02)
    random = np.random.default_rng(1)
    x, (left, right) = random.uniform(-2, 2, (5, 3)), random.uniform(-1, 1, (2, 5))
    dt = np.full(5, 0.1)
    after = Unicycle(0, 0).f(x, np.column_stack([(left + right) / 2, (right - left) / W, dt]))
    assert robot.f(x, np.column_stack([left, right, dt])) == pytest.approx(after)


def test_a_skid_steered_robot_slides_to_its_left():
    """u_y is along the robot's y-axis: north, when it looks east."""
    robot = SkidSteer(((0.5, 0.5), (0.1, 0.1), (0.0, 0.0)), 0.02)
    assert robot.f(np.zeros(3), np.array([1.0, 1.0, 2.0])) == pytest.approx([2, 0.4, 0])
