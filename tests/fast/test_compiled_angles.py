"""Compiled directions are those of the library, to the last digit or the one before it."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

angles = pytest.importorskip("ekfsim.fast.compiled.angles", exc_type=ImportError)


@pytest.mark.parametrize("reach", [0.1, 4.0, 1e3, 9e5, 1e9])
def test_cosines_and_sines_are_right_to_the_last_digits(reach):
    angle = np.random.default_rng(0).uniform(-reach, reach, 2000)
    angle[:9] = np.arange(-4, 5) * math.pi / 2
    verify(angle)


def test_one_that_is_no_number_spoils_no_other():
    verify(np.array([math.nan, 0.3, math.inf, -3.0, 0.0, -0.0]))


def verify(angle):
    cosine, sine = np.empty(angle.shape), np.empty(angle.shape)
    angles.directions(angle, cosine, sine)
    with np.errstate(invalid="ignore"):
        assert_allclose(cosine, np.cos(angle), 0, 2.5e-16)
        assert_allclose(sine, np.sin(angle), 0, 2.5e-16)
