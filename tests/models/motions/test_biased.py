"""Motions whose input is measured wrongly by what the state holds."""

import math

import numpy as np
import pytest

from ekfsim.models.motions.biased import Biased, Misread
from ekfsim.systems import SYSTEMS
from ekfsim.systems.estimating import STATES, Estimate, Estimating, estimable
from ekfsim.systems.faults import DriveFaults

ROBOTS = {name: system.robot for name, system in SYSTEMS.items()}
CASES = [(name, error) for name, robot in ROBOTS.items() for error in estimable(robot)]


def estimating(name, *errors, drift=0.0):
    robot = ROBOTS[name]
    return Estimating(robot, tuple((error, Estimate(0.1, drift)) for error in errors))


def states(robot, n, random):
    """Anywhere, some at the seam of the heading, with errors of a few percent."""
    k, own = len(robot.layout.names), len(robot.robot.layout.names)
    x = random.uniform(-4, 4, (n, k))
    x[..., robot.layout.heading] = random.choice([-3.1, 3.1, 0.4, math.pi], n)
    x[..., own:] = random.uniform(-0.08, 0.08, (n, k - own))
    return x


def inputs(motion, n, random):
    u = random.uniform(0.2, 0.9, (n, len(motion.inputs)))
    return u


def test_each_robot_may_find_its_faults_and_one_scale_of_its_way():
    assert {name: estimable(robot) for name, robot in ROBOTS.items()} == {
        "mower": ("gyro_bias", "wheel_scale", "left_scale", "right_scale"),
        "pioneer": ("wheel_scale", "left_scale", "right_scale"),
        "gnss": ("wheel_scale", "left_scale", "right_scale"),
        "pylon": ("forward_bias", "lateral_bias", "yaw_bias"),
        "landmarks": ("gyro_bias", "wheel_scale", "turn_scale"),
        "ranges": ("gyro_bias", "wheel_scale", "turn_scale"),
    }


@pytest.mark.parametrize(("name", "error"), CASES)
def test_an_input_that_is_misread_moves_the_robot_as_the_right_one_does(name, error):
    """What the simulation's faults do to an input, the state undoes."""
    robot, random = estimating(name, error), np.random.default_rng(3)
    motion, own = robot.motion("corrected"), robot.robot.motion("corrected")
    x, right = states(robot, 50, random), inputs(own, 50, random)
    value = 0.06
    x[..., -1] = value
    told = value + 1 if error.endswith("_scale") else value
    faults = (
        {"distance_scale": told} if "distance_scale" in robot.faults
        else {"left_scale": told, "right_scale": told}
    ) if error == "wheel_scale" else {error: told}  # fmt: skip
    measured = DriveFaults(**faults).misread(right, robot.faults, robot.over)
    assert not np.allclose(measured, right)
    n = len(robot.robot.layout.names)
    np.testing.assert_allclose(motion.f(x, measured)[..., :n], own.f(x[..., :n], right), atol=1e-12)
    np.testing.assert_array_equal(motion.f(x, measured)[..., n:], x[..., n:])


@pytest.mark.parametrize("name", ROBOTS)
def test_its_jacobians_equal_central_differences(name):
    """With all that its robot may find at once. G tells of the noise of the mower's wheels what its
    document has it do (eq. 22), which is no derivative.
    """
    robot, random = estimating(name, *estimable(ROBOTS[name])), np.random.default_rng(4)
    motion, step = robot.motion("corrected"), 1e-6
    x, u = states(robot, 40, random), inputs(robot.motion("corrected"), 40, random)
    headings = list(robot.layout.headings)

    def slope(ahead, behind):
        apart = ahead - behind
        apart[..., headings] = np.angle(np.exp(1j * apart[..., headings]))
        return apart / (2 * step)

    F, G = motion.F(x, u), motion.G(x, u)
    for i in range(x.shape[-1]):
        d = np.eye(x.shape[-1])[i] * step
        by_x = slope(motion.f(x + d, u), motion.f(x - d, u))
        np.testing.assert_allclose(F[..., i], by_x, rtol=1e-6, atol=1e-7)
    for i in range(2 if name == "mower" else 0, u.shape[-1]):
        d = np.eye(u.shape[-1])[i] * step
        by_u = slope(motion.f(x, u + d), motion.f(x, u - d))
        np.testing.assert_allclose(G[..., i], by_u, rtol=1e-6, atol=1e-7)


def test_an_error_wanders_by_its_drift_and_nothing_else_does():
    robot = estimating("mower", "gyro_bias", "wheel_scale", drift=0.02)
    motion, u = robot.motion("corrected"), np.array([0.01, 0.02, 0.3, 0.25])
    Q = motion.Q(u)
    np.testing.assert_array_equal(Q[:3, :3], robot.robot.process)
    np.testing.assert_allclose(np.diag(Q)[3:], 0.02**2 * 0.25)
    assert not Q[:3, 3:].any()
    assert not Q[3, 4]
    np.testing.assert_array_equal(motion.M(u), robot.robot.motion("corrected").M(u))


def test_an_input_without_a_time_lasts_a_tick():
    robot = estimating("pioneer", "wheel_scale", drift=0.5)
    motion = robot.motion("corrected")
    assert isinstance(motion, Biased)
    assert (motion.dt, motion.tick) == (None, 0.1)
    np.testing.assert_allclose(motion.Q(np.array([0.1, 0.1]))[3, 3], 0.25 * 0.1)


def test_one_input_moves_many_states_and_many_inputs_one():
    robot, random = estimating("ranges", "gyro_bias", "wheel_scale"), np.random.default_rng(5)
    motion = robot.motion("corrected")
    x, u = states(robot, 7, random), inputs(motion, 7, random)
    for states_of, inputs_of in ((x, u[0]), (x[0], u), (x[:, None], u[None])):
        f, F = motion.f(states_of, inputs_of), motion.F(states_of, inputs_of)
        axes = np.broadcast_shapes(states_of.shape[:-1], inputs_of.shape[:-1])
        assert (f.shape, F.shape) == ((*axes, 5), (*axes, 5, 5))
    np.testing.assert_allclose(motion.f(x[:, None], u[None])[2, 4], motion.f(x[2], u[4]))
    np.testing.assert_allclose(motion.F(x[:, None], u[None])[2, 4], motion.F(x[2], u[4]))


def test_the_state_is_the_robot_s_with_the_errors_behind():
    robot = estimating("gnss", "wheel_scale", "left_scale")
    layout, own = robot.layout, robot.robot.layout
    assert layout.names == (*own.names, STATES["wheel_scale"], STATES["left_scale"])
    assert (layout.places, layout.headings) == (own.places, own.headings)
    P = robot.first_covariance("corrected")
    np.testing.assert_array_equal(P[:4, :4], robot.robot.first_covariance("corrected"))
    np.testing.assert_allclose(np.diag(P)[4:], 0.01)
    assert Misread((0, 1), True) == robot.motion("corrected").errors[0]
