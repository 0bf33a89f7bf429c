import math

import numpy as np
import pytest
from numerics import jacobian

from ekfsim.models.layout import INERTIAL
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset, from_global, to_global


def test_the_lidars_own_frame_is_the_global_one_turned_back():
    x = np.random.default_rng(5).uniform(-3, 3, (9, 7))
    seen = LidarOffset(5, -5, 0.0075, INERTIAL).h(x)
    offset = LandmarkOffset(5, -5, 0.0075, 0.0075, INERTIAL).h(x)
    assert to_global(seen, x[:, 5]) == pytest.approx(offset, abs=1e-12)
    assert from_global(offset, x[:, 5]) == pytest.approx(seen, abs=1e-12)
    ahead = np.zeros(7)  # at the origin, looking east: the pylon is 5 m ahead and 5 m to the right
    assert LidarOffset(5, -5, 0.0075, INERTIAL).h(ahead) == pytest.approx([5, 5])


@pytest.mark.parametrize(
    ("heading", "expected"),
    [(0, (7, -2)), (90, (2, 7)), (180, (-7, 2)), (-90, (-2, -7))],
    ids=["E", "N", "W", "S"],
)
def test_seven_ahead_and_two_to_the_right(heading, expected):
    assert to_global(np.array([2.0, 7.0]), math.radians(heading)) == pytest.approx(
        expected, abs=1e-12
    )


def test_many_readings_turn_at_once():
    random = np.random.default_rng(1)
    z, θ = random.uniform(-5, 5, (4, 2)), random.uniform(-3, 3, 4)
    assert to_global(z, θ) == pytest.approx(
        np.array([to_global(*one) for one in zip(z, θ, strict=True)])
    )


def test_what_the_lidar_sees_of_the_pylon_is_the_offset():
    """A robot that stands at p and looks along θ sees X_L − p turned into its frame; turned back it
    is eq. 9."""
    random = np.random.default_rng(2)
    for _ in range(20):
        x = np.zeros(7)
        x[[1, 3, 5]] = random.uniform(-3, 3, 3)
        east, north = 5 - x[1], -5 - x[3]
        c, s = math.cos(x[5]), math.sin(x[5])
        lidar = np.array([s * east - c * north, c * east + s * north])  # to the right, ahead
        sensor = LandmarkOffset(5, -5, 0.0075, 0.0075, INERTIAL)
        assert to_global(lidar, x[5]) == pytest.approx(sensor.h(x), abs=1e-12)


def test_an_error_of_the_yaw_moves_the_reading_sideways():
    x = np.array([1.0, 2.0, 0.4])
    sensor = LandmarkOffset(5, -5, 0.0075, 0.01, yaw_sigma=0.02)
    h, _, R = sensor.linearize(x)
    c, s = math.cos(0.4), math.sin(0.4)
    lidar = np.array([s * h[0] - c * h[1], c * h[0] + s * h[1]])
    J = jacobian(lambda θ: to_global(lidar, θ[0]), np.array([0.4]))
    np.testing.assert_allclose(J[:, 0], [-h[1], h[0]], atol=1e-8)
    np.testing.assert_allclose(R, np.diag([0.0075**2, 0.01**2]) + 0.02**2 * J @ J.T, atol=1e-10)
