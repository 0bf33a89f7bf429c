import math

import numpy as np

from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry.ellipse import radius_factor


def in_ellipse(P, e, p=0.954):
    return bool(
        inside_ellipse(
            Gaussian(np.array([*e, 9.0]), np.pad(np.array(P, float), (0, 1))),
            np.array([0, 0, 1.0]),
            p,
        )
    )


def test_inside_the_ellipse():
    k = radius_factor(0.954)
    for turn in np.linspace(0, 6, 7):
        c, s = math.cos(turn), math.sin(turn)
        e = np.array([0.3 * c, 0.1 * s])
        assert in_ellipse(np.diag([0.09, 0.01]), 0.999 * k * e)
        assert not in_ellipse(np.diag([0.09, 0.01]), 1.001 * k * e)


def test_inside_an_ellipse_without_width():
    line = np.array([[0.5, 0.5], [0.5, 0.5]])
    assert in_ellipse(line, (1.0, 1.0))
    assert not in_ellipse(line, (2.0, 2.0))
    assert not in_ellipse(line, (0.1, -0.1))
    assert in_ellipse(np.zeros((2, 2)), (0, 0))
    assert not in_ellipse(np.zeros((2, 2)), (2e-6, 0))


def in_cone(variance, e, p=0.954):
    return bool(
        inside_cone(
            Gaussian(np.array([9, 9, e]), np.diag([1, 1, variance])), np.array([1.0, 1.0, 0.0]), p
        )
    )


def test_inside_the_cone():
    assert in_cone(0.04, 0.399)
    assert not in_cone(0.04, -0.401)
    assert in_cone(0.04, 2 * math.pi - 0.3)
    assert in_cone(0.04, 0.15, p=0.55)
    assert not in_cone(0.04, 0.16, p=0.55)
    assert in_cone(0.0, 0.9e-6)
    assert not in_cone(0.0, 1.1e-6)
