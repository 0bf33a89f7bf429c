import csv
import math
from pathlib import Path

import numpy as np
import pytest

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import INERTIAL
from ekfsim.models.motions.planar_imu import PlanarImu
from ekfsim.models.sensors.offset import LandmarkOffset, to_global

LOG = (
    Path(__file__).parents[2]
    / ".."
    / "shared"
    / "data"
    / "pylon"
    / "2020_2_26__17_21_59_filtered.csv"
)


def test_the_position_moves_at_the_old_speed():
    x = np.array([1.0, 10.0, 2.0, 20.0, 0.5, 0.3, 0.1])
    after = PlanarImu().f(x, np.array([4.0, 0.0, math.pi / 2, 0.1]))
    assert after == pytest.approx([1, 10.1, 2.4, 20.2, 2.0, math.pi / 2, 0.3])


def test_a_push_to_the_left_is_north_when_the_cart_looks_east():
    after = PlanarImu().f(np.zeros(7), np.array([0.0, 1.0, 0.0, 0.1]))
    assert after == pytest.approx([0, 0, 0.1, 0, 0, 0, 0])


def test_a_turn_through_south_west_is_short():
    x = np.array([0.0, 0, 0, 0, 0, -3.1, 3.1])
    u = np.array([0.0, 0, -3.1, 0.1])
    assert PlanarImu().f(x, u)[4] == pytest.approx((2 * math.pi - 6.2) / 0.1)
    assert PlanarImu(wrapped=False).f(x, u)[4] == pytest.approx(-62)


def test_in_no_time_the_turn_rate_stays():
    x = np.array([1.0, 2, 3, 4, 0.7, 0.3, 0.1])
    model, u = PlanarImu(), np.array([1.0, 1.0, 0.4, 0.0])
    assert model.f(x, u) == pytest.approx([1, 2, 3, 4, 0.7, 0.4, 0.3])
    assert model.F(x, u)[4] == pytest.approx([0, 0, 0, 0, 1, 0, 0])


def test_the_noise_is_the_documents():
    assert PlanarImu().M(np.ones(4)) == pytest.approx(np.diag([1.8373, 1.1991, 0.00058709, 0]))


def filtered(imu):
    """The authors' filter on their log: a prediction of 0.1 s and a correction for each row."""
    ekf, belief = EKF(headings=INERTIAL.headings), Gaussian(np.zeros(7), np.eye(7))
    pylon = LandmarkOffset(5.0, -5.0, 0.0075, 0.0075, INERTIAL)
    beliefs = []
    with LOG.open() as rows:
        for row in csv.reader(rows):
            right, ahead, yaw, a_x, a_y = (float(row[i]) for i in (0, 1, 6, 9, 10))
            θ = float(wrap(np.radians(-yaw)))
            belief, _ = ekf.predict(belief, imu, np.array([a_x, a_y, θ, 0.1]))
            belief, _ = ekf.update(belief, pylon, to_global(np.array([right, ahead]), θ))
            beliefs.append(belief)
    return beliefs


def path_error(beliefs):
    """RMSE of the distance to the square's outline.          eqs 11, 12"""
    x, y = np.array([belief.mean[[1, 3]] for belief in beliefs]).T
    from_outline = np.min(np.abs([x - 10, x, y + 10, y]), axis=0)
    beyond = np.hypot(np.maximum(np.maximum(-x, x - 10), 0), np.maximum(np.maximum(y, -10 - y), 0))
    both = ((x < 0) | (x > 10)) & ((y > 0) | (y < -10))
    return np.sqrt(np.mean(np.where(both, beyond, from_outline) ** 2))


@pytest.mark.skipif(not LOG.exists(), reason="the recorded pylon log is not here")
def test_the_authors_filter_on_their_log():
    """Row: x, y, ẋ, ẏ, θ and the variances of x and y, from an independent run of their code."""
    expected = {
        0: ((0.157577, -0.145731, 0.015602, -0.014429, 0.000000), (5.6247e-05, 5.6247e-05)),
        1: ((0.148061, -0.132813, -0.094538, 0.128368, 0.000000), (5.5940e-05, 5.5938e-05)),
        2: ((0.151754, -0.138834, 0.005190, -0.007394, 0.000000), (5.0147e-05, 4.9290e-05)),
        10: ((0.167708, -0.119587, -0.010448, 0.027601, 0.003272), (4.8715e-05, 4.6887e-05)),
        100: ((4.751742, 0.058660, 0.759268, -0.157790, -0.015272), (4.8714e-05, 4.6891e-05)),
        350: ((10.487867, -8.957226, 0.644122, 0.665278, -1.684243), (4.6898e-05, 4.8706e-05)),
        706: ((0.185941, -0.240789, -0.048696, 0.023683, -0.007636), (4.8715e-05, 4.6888e-05)),
    }
    beliefs = filtered(PlanarImu(wrapped=False))
    for row, (state, variances) in expected.items():
        x, P = beliefs[row]
        assert x[[1, 3, 0, 2, 5]] == pytest.approx(state, abs=1e-6)
        assert np.diag(P)[[1, 3]] == pytest.approx(variances, abs=1e-9)
    assert path_error(beliefs) == pytest.approx(0.230198957, abs=1e-9)


@pytest.mark.skipif(not LOG.exists(), reason="the recorded pylon log is not here")
def test_what_the_minus_of_eq_5_costs():
    assert path_error(filtered(PlanarImu(wrapped=False, lateral_sign=-1.0))) == pytest.approx(
        0.231986, abs=1e-6
    )
