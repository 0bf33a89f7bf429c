"""Ways to drive: where they lead, and how long they take."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.systems.drives import Circle, Spiral, Square, Stretch, Stretches

START = np.array([1.0, 2.0, 0.5])


@pytest.mark.parametrize("dt", [0.01, 0.1, 0.07])
@pytest.mark.parametrize(
    "drive",
    [Square(), Square(3.0, clockwise=True, laps=2), Circle(), Circle(laps=2, clockwise=True)],
)
def test_squares_and_circles_close(drive, dt):
    poses = drive.course(dt).poses(START, dt)
    assert_allclose(poses[-1, :2], START[:2], rtol=0, atol=1e-9)
    sign = -1 if drive.clockwise else 1
    assert poses[-1, 2] - START[2] == pytest.approx(sign * 2 * math.pi * drive.laps)


def test_a_square_has_its_corners():
    poses = Square(side=2.0).course(0.1).poses(np.zeros(3), 0.1)
    for corner in [(2, 0), (2, 2), (0, 2)]:
        assert np.hypot(*(poses[:, :2] - corner).T).min() < 1e-9
    assert poses[:, :2].min() > -1e-9
    assert poses[:, :2].max() < 2 + 1e-9


def test_no_side_is_driven_faster_than_asked():
    course = Square(side=2.0, speed=0.3, turn_rate=1.0).course(0.1)
    assert 0.29 < course.speed.max() <= 0.3
    assert course.turn_rate.max() <= 1.0


def test_a_circle_is_round():
    """Chords of the mid-point rule are as long as arcs, so its circle is wider by radius ·
    turn²/24: by 0.05 mm."""
    poses = Circle(radius=2.0, speed=0.5).course(0.1).poses(np.zeros(3), 0.1)
    assert_allclose(np.hypot(poses[:, 0], poses[:, 1] - 2.0), 2.0, rtol=0, atol=1.1e-4)


def test_a_list_of_speeds_is_driven_as_it_stands():
    course = Stretches((Stretch(1.0, 0.0, 2.0), Stretch(0.5, -0.5, 0.5))).course(0.1)
    assert course.speed.tolist() == [1.0] * 20 + [0.5] * 5
    assert course.turn_rate.tolist() == [0.0] * 20 + [-0.5] * 5
    assert not course.held


def test_no_tick_is_lost_where_stretches_are_no_whole_number_of_ticks():
    course = Stretches((Stretch(1.0, 0.0, 0.14),) * 10).course(0.1)
    assert len(course.speed) == 14


@pytest.mark.parametrize("clockwise", [False, True])
def test_the_spiral_fills_its_field_in_its_time(clockwise):
    """549 s at 100 Hz in 75 × 50 m: begun along the longer side, then 4 m further in with every
    round."""
    course = Spiral(clockwise=clockwise).course(0.01)
    poses = course.poses(np.zeros(3), 0.01)
    assert len(course.speed) == 54_900
    assert np.ptp(course.speed) == 0
    assert 1.0 < course.speed[0] < 1.2  # m/s, a walk
    middle = np.array([0.0, -25.0 if clockwise else 25.0])
    outwards = np.hypot(*((poses[:, :2] - middle) / [37.5, 25.0]).T)
    assert outwards[0] == pytest.approx(1.0, abs=0.01)
    assert outwards[-1] == pytest.approx(0.2, abs=0.01)
    assert np.all(np.diff(outwards[::1000]) < 0)
    assert (poses[-1, 2] - poses[0, 2]) * (-1 if clockwise else 1) == pytest.approx(
        2 * math.pi * 5, abs=0.2
    )
