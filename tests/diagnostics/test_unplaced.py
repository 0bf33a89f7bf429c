import numpy as np
import pytest

from ekfsim.diagnostics.unplaced import Unplaced
from ekfsim.filters.belief import Gaussian, Particles
from ekfsim.models.layout import POSE

FLOOR = np.diag([100 / 12, 64 / 12, 3.3])  # of 10 m by 8 m


def crowd(P):
    return Particles(np.zeros(3), P, np.zeros((2, 3)), np.full(2, 0.5))


@pytest.mark.parametrize(("share", "told"), [(1.0, True), (0.251, True), (0.249, False)])
def test_a_crowd_tells_a_place_once_it_spreads_over_a_quarter_of_the_floor(share, told):
    """Of the area: narrower along one axis alone, and turned."""
    c, s = np.cos(0.7), np.sin(0.7)
    turned = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    P = turned @ FLOOR @ np.diag([share**2, 1.0, 1.0]) @ turned.T
    assert Unplaced(crowd(FLOOR), POSE).at(crowd(P)) is told


def test_who_began_at_a_place_is_never_without_one():
    unplaced = Unplaced(Gaussian(np.zeros(3), 0.01 * np.eye(3)), POSE)
    assert not unplaced.at(Gaussian(np.zeros(3), 1e4 * np.eye(3)))
    assert not unplaced.at(crowd(FLOOR))
