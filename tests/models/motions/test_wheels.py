import math

import numpy as np
import pytest
from numerics import jacobian

from ekfsim.models.motions.wheels import GyroWheels, TwoWheels

Q = np.diag([1e-4, 1e-4, 7.62e-5])
WHEELS, GYRO = TwoWheels(1.41, 0.01, Q), GyroWheels(1.41, 0.01, Q)


def test_half_a_circle_by_hand():
    """One wheel stands still, the other goes half round it: the mid-point rule drives north all the
    way."""
    x = WHEELS.f(np.array([0.0, 0.0, 0.0]), np.array([0.0, 1.41 * math.pi]))
    assert x == pytest.approx([0, 1.41 * math.pi / 2, math.pi], abs=1e-12)


def test_the_gyro_turns_and_the_wheels_drive():
    """The listing's lines: argmnt = Phi + dPhiFOG/2*dT; x(1) = xM + dD*cos(argmnt); x(3) = Phi +
    dPhiFOG*dT."""
    x, dD_l, dD_r, fog, dT = np.array([3.0, -2.0, 0.7]), 0.02, 0.03, 0.4, 0.01
    argument, dD = 0.7 + fog / 2 * dT, (dD_l + dD_r) / 2
    expected = [3 + dD * math.cos(argument), -2 + dD * math.sin(argument), 0.7 + fog * dT]
    assert GYRO.f(x, np.array([dD_l, dD_r, fog, dT])) == pytest.approx(expected, abs=1e-15)


def test_with_a_gyro_that_agrees_with_the_wheels_both_models_are_one():
    random = np.random.default_rng(1)
    x, wheels = random.uniform(-3, 3, (9, 3)), random.uniform(-0.1, 0.1, (9, 2))
    rate = (wheels[:, 1] - wheels[:, 0]) / 1.41 / 0.01
    u = np.column_stack([wheels, rate, np.full(9, 0.01)])
    assert GYRO.f(x, u) == pytest.approx(WHEELS.f(x, wheels), abs=1e-14)
    assert GYRO.F(x, u) == pytest.approx(WHEELS.F(x, wheels), abs=1e-14)
    assert GYRO.G(x, u)[..., :2] == pytest.approx(WHEELS.G(x, wheels), abs=1e-14)


@pytest.mark.parametrize("seed", range(10))
def test_the_noise_enters_by_the_wheels_at_the_heading_of_the_gyro(seed):
    """B is the derivative of eqs 16 to 18 with ΔΦ = ω dt + what the wheels' errors turn the robot
    by."""
    random = np.random.default_rng(seed)
    x, u = random.uniform(-1, 1, 3), np.append(random.uniform(-1, 1, 3), 0.01)

    def f(wheels):
        turn = u[2] * u[3] + ((wheels[1] - u[1]) - (wheels[0] - u[0])) / 1.41
        middle, way = x[2] + turn / 2, wheels.sum() / 2
        return np.array([x[0] + way * math.cos(middle), x[1] + way * math.sin(middle), x[2] + turn])

    assert GYRO.G(x, u)[:, :2] == pytest.approx(jacobian(f, u[:2]), abs=1e-8)


def test_the_noise_is_the_documents():
    u = np.array([0.01, 0.01, 0.1, 0.01])
    assert np.array_equal(GYRO.M(u), np.diag([1e-4, 1e-4, 0, 0]))
    assert np.array_equal(GYRO.Q(u), Q)
    assert np.array_equal(GyroWheels(1.41, 0.01, Q, 0.5).M(u), np.diag([1e-4, 1e-4, 0.25, 0]))
    assert TwoWheels(1.41, 0.01).Q(u[:2]) == 0.0
