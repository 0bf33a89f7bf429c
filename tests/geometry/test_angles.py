import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.geometry.angles import wrap

angle = st.floats(-1e6, 1e6)
inside = st.floats(-math.pi, math.pi, exclude_min=True)
WAYS = [lambda a: float(wrap(np.array(a))), wrap_one]


@pytest.mark.parametrize("wrapped", WAYS)
@given(angle)
@example(3 * math.pi)
@example(-3 * math.pi)
@example(np.radians(540.0))
@example(-math.pi)
@example(np.nextafter(math.pi, 4))
@example(np.nextafter(-math.pi, -4))
def test_the_same_direction_within_half_a_turn(wrapped, a):
    assert -math.pi < wrapped(a) <= math.pi
    assert math.remainder(wrapped(a) - a, 2 * math.pi) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("wrapped", WAYS)
@given(st.integers(-2000, 2000))
def test_odd_half_turns_look_backwards_and_stay_in_range(wrapped, k):
    back = wrapped((2 * k + 1) * math.pi)
    assert -math.pi < back <= math.pi
    assert math.cos(back) == pytest.approx(-1)


@pytest.mark.parametrize("wrapped", WAYS)
@given(inside)
def test_an_angle_already_there_comes_back_untouched(wrapped, a):
    assert wrapped(a) == a


def test_minus_half_a_turn_is_half_a_turn():
    assert wrap(np.array([-math.pi, math.pi, 0.0, -0.0])).tolist() == [math.pi, math.pi, 0.0, 0.0]


def test_any_shape():
    a = np.linspace(-20, 20, 24).reshape(2, 3, 4)
    assert wrap(a).shape == a.shape
    assert wrap(a) == pytest.approx(np.angle(np.exp(1j * a)))


def test_nan_stays_nan():
    assert np.isnan(wrap(np.array(np.nan)))
