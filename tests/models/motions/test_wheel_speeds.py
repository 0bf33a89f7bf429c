import math
from pathlib import Path

import numpy as np
import pytest

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.models.layout import SPEED_POSE
from ekfsim.models.motions.wheel_speeds import WheelSpeeds, WheelSpeedsAsWritten
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.position import Position

DATA = Path(__file__).parents[2] / ".." / "shared" / "data" / "mower_gnss"
LOGGED = pytest.mark.skipif(
    not DATA.exists(), reason="the recorded wheel speeds and fixes are not here"
)

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
    """With V = (v_L + v_R)/2 and φ̇ = (v_R − v_L)/(2R), T M Tᵀ = diag(density²)/dt: one stands
    apart from the other."""
    T = np.array([[0.5, 0.5], [-1 / 0.54, 1 / 0.54]])
    M = MODEL.M(np.array([1.0, 1.2, 0.005]))[:2, :2]
    np.testing.assert_allclose(T @ M @ T.T, np.diag([0.10**2, 0.30**2]) / 0.005, atol=1e-12)


def test_ten_short_steps_are_as_uncertain_as_a_long_one():
    """What white noise leaves in the heading grows with the time, not with the number of steps."""

    def heading_variance(dt):
        u = np.array([1.0, 1.0, dt])
        G = MODEL.G(np.zeros(4), u)
        return (G @ MODEL.M(u) @ G.T)[1, 1]

    assert (
        10 * heading_variance(0.01)
        == pytest.approx(heading_variance(0.1))
        == pytest.approx(0.3**2 * 0.1)
    )


def log(name):
    return np.loadtxt(DATA / f"{name}-1.csv", delimiter=",", skiprows=1)


def position_error(means):
    return np.sqrt(
        np.mean(np.sum((np.array(means)[:, 2:] - log("groundtruth")[:, 1:3]) ** 2, axis=1))
    )


def predicted(model, corrected, first):
    """The means at all rows of the wheels; corrected(row, t, belief before, belief) takes what
    fixes there are."""
    wheels, ekf, belief = log("wheelspeeds"), EKF(headings=SPEED_POSE.headings), first
    means = [first.mean]
    for row in range(1, len(wheels)):
        before, (t, right, left) = belief, wheels[row]
        belief, _ = ekf.predict(belief, model, np.array([left, right, t - wheels[row - 1, 0]]))
        belief = corrected(row, t, before, belief)
        means.append(belief.mean)
    return means


def start():
    _, x, y, φ = log("groundtruth")[0]
    return Gaussian(np.array([0.0, φ, x, y]), np.diag([1.0, 0.05, 0.05, 0.05]) ** 2)


@LOGGED
def test_wheels_alone_drift_as_the_documents_sums_do():
    means = predicted(MODEL, lambda row, t, before, belief: belief, start())
    assert position_error(means) == pytest.approx(2.0100, abs=1e-4)


@LOGGED
def test_with_fixes_it_beats_them():
    """A reference filter on x, y, φ has 0.0846 m here; the raw fixes 0.1975 m."""
    fixes, sensor = iter(log("gnss")), Position(0.15, 0.15, SPEED_POSE)
    ahead = [next(fixes)]

    def corrected(row, t, before, belief):
        while ahead and ahead[0][0] <= t + 1e-9:
            belief, _ = EKF(headings=SPEED_POSE.headings).update(belief, sensor, ahead.pop()[1:])
            ahead.extend(fix for fix in [next(fixes, None)] if fix is not None)
        return belief

    assert position_error(predicted(MODEL, corrected, start())) == pytest.approx(0.0847, abs=5e-4)


@LOGGED
def test_the_recipe_is_several_times_worse_than_the_fixes_it_is_given():
    """A fix at every row, interpolated, and the innovation at the state before the prediction: as
    its authors do."""
    times, fixes, sensor = log("wheelspeeds")[:, 0], log("gnss"), Position(1.0, 1.0, SPEED_POSE)
    x, y = (np.interp(times, fixes[:, 0], fixes[:, column]) for column in (1, 2))

    def corrected(row, t, before, belief):
        ekf = EKF(headings=SPEED_POSE.headings)
        return ekf.update(belief, Frozen(sensor, before.mean), np.array([x[row], y[row]]))[0]

    means = predicted(WheelSpeedsAsWritten(), corrected, Gaussian(np.zeros(4), np.eye(4)))
    assert position_error(means) > 5 * 0.1975
