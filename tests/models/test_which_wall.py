"""The other walls that a beam may meet: each as a laser has it in a world of that wall alone."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls

# a step in the wall ahead, whose parts are not square to each other
ENDS = {"near": ((4.0, -9.0), (4.4, 0.0)), "far": ((6.0, 0.0), (7.0, 9.0))}
STEP = Walls.of({}, {name: np.array(ends) for name, ends in ENDS.items()})


def without_an_end(name):
    """The line that a wall lies on, 50 times as long."""
    a, b = (np.array(end) for end in ENDS[name])
    return Walls.of({}, {name: np.array([a - 50 * (b - a), b + 50 * (b - a)])})


@pytest.mark.parametrize("bearing", [0.3, -0.4, 0.0])
@pytest.mark.parametrize("pose", [(0.0, -1.2, 0.2), (0.5, 0.4, 0.1), (0.2, -0.1, -0.1)])
def test_each_is_read_as_a_wall_without_an_end(pose, bearing):
    """Range, derivatives and noise, all at the mean, wherever it is seen from."""
    x, P = np.array(pose), np.diag([0.2, 1.0, 0.2])
    other = Laser(STEP, bearing, 0.02).alternatives(x, P)
    assert other.wall[:2].tolist() in ([0, 1], [1, 0])
    assert float(other.share.sum()) == pytest.approx(1)
    for i, wall in enumerate(other.wall[:2].tolist()):
        alone = Laser(without_an_end(tuple(ENDS)[wall]), bearing, 0.02)
        assert_allclose(other.h[i], alone.h(x), rtol=1e-9)
        assert_allclose(other.H[i], alone.H(x), rtol=1e-9, atol=1e-9)
        assert_allclose(other.R[i], alone.R(x), rtol=1e-9)


def test_of_a_wall_that_the_mean_cannot_see_nothing_is_expected():
    """From elsewhere the beam meets it ahead; from the mean it would lie behind: its share is
    nobody's."""
    behind = Walls.of({}, {"ahead": np.array([[5.0, -9], [5, 9]]),
                           "aside": np.array([[-3.0, 0.3], [3.0, 0.9]])})  # fmt: skip
    x, P = np.array([0.0, 1.0, 0.4]), np.diag([0.01, 0.3, 0.001])
    other = Laser(behind, 0.0, 0.02).alternatives(x, P)
    assert not other.share[np.isnan(other.h[:, 0])].any()
    assert (other.wall[other.share == 0] == -1).all()
    assert math.isfinite(float(other.h[0, 0]))
