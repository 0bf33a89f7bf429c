import math

import numpy as np
import pytest

from ekfsim.models.wheel_speeds import WheelSpeeds

MODEL = WheelSpeeds(0.27, 0.10, 0.30)


def test_one_step_by_hand():
    x = MODEL.f(np.array([9.0, 0.5, 1.0, 2.0]), np.array([0.9, 1.1, 0.1]))
    φ = 0.5 + 0.2 / 0.54 * 0.1
    assert x == pytest.approx([1, φ, 1 + 0.1 * math.cos(φ), 2 + 0.1 * math.sin(φ)])


def test_the_old_speed_is_forgotten():
    random = np.random.default_rng(1)
    x, u = random.uniform(-1, 1, 4), np.array([0.9, 1.1, 0.1])
    assert not MODEL.F(x, u)[:, 0].any()
    assert not MODEL.F(x, u)[0].any()


def test_the_noise_is_white_in_speed_and_turn_rate():
    """With V = (v_L + v_R)/2 and φ̇ = (v_R − v_L)/(2R), T M Tᵀ = diag(density²)/dt: one stands apart from the other."""
    T = np.array([[0.5, 0.5], [-1 / 0.54, 1 / 0.54]])
    M = MODEL.M(np.array([1.0, 1.2, 0.005]))[:2, :2]
    np.testing.assert_allclose(T @ M @ T.T, np.diag([0.10**2, 0.30**2]) / 0.005, atol=1e-12)


def test_ten_short_steps_are_as_uncertain_as_a_long_one():
    """What white noise leaves in the heading grows with the time, not with the number of steps."""

    def heading_variance(dt):
        u = np.array([1.0, 1.0, dt])
        G = MODEL.G(np.zeros(4), u)
        return (G @ MODEL.M(u) @ G.T)[1, 1]

    assert 10 * heading_variance(0.01) == pytest.approx(heading_variance(0.1)) == pytest.approx(0.3**2 * 0.1)
