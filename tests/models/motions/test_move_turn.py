import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numerics import jacobian

from ekfsim.models.motions.move_turn import MoveTurn

MODEL = MoveTurn(0.02, 0.03)
metres = st.floats(-20, 20)
headings = st.floats(-3.1, 3.1)
turns = st.floats(-10, 10)
poses = st.tuples(metres, metres, headings).map(np.array)
inputs = st.tuples(metres, turns).map(np.array)


def unwrapped(x, u):
    """The assignment's Φ."""
    return np.array([x[0] + u[0] * math.cos(x[2]), x[1] + u[0] * math.sin(x[2]), x[2] + u[1]])


@given(poses, inputs)
def test_it_drives_at_the_old_heading_and_then_turns(x, u):
    after, ideal = MODEL.f(x, u), unwrapped(x, u)
    assert after[:2] == pytest.approx(ideal[:2], abs=1e-12)
    assert -math.pi < after[2] <= math.pi
    assert math.cos(after[2] - ideal[2]) == pytest.approx(1)
    assert math.sin(after[2] - ideal[2]) == pytest.approx(0, abs=1e-12)


@given(poses, inputs)
def test_F_equals_central_differences(x, u):
    assert MODEL.F(x, u) == pytest.approx(jacobian(lambda x: unwrapped(x, u), x), abs=1e-7)


@given(poses, inputs)
def test_G_equals_central_differences(x, u):
    assert MODEL.G(x, u) == pytest.approx(jacobian(lambda u: unwrapped(x, u), u), abs=1e-7)


@given(inputs)
def test_the_noise_grows_with_the_motion_measured(u):
    M = MODEL.M(u)
    np.testing.assert_allclose(M, np.diag([(0.02 * u[0]) ** 2, (0.03 * u[1]) ** 2]))
    assert np.array_equal(MODEL.M(-u), M)
    assert MODEL.Q(u) == 0


@given(poses, inputs)
def test_all_at_once_equals_one_by_one(x, u):
    one_by_one = (MODEL.f(x, u), MODEL.F(x, u), MODEL.G(x, u), MODEL.M(u), MODEL.Q(u))
    for at_once in (MODEL.linearize(x, u), (v[0] for v in MODEL.linearize(x[None], u[None])[:4])):
        for got, expected in zip(at_once, one_by_one, strict=False):
            assert got == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("axes", [(1,), (5,), (3, 2)])
def test_a_batch_equals_its_runs(axes):
    random = np.random.default_rng(1)
    x, u = random.uniform(-3, 3, (*axes, 3)), random.uniform(-3, 3, (*axes, 2))
    for function in (MODEL.f, MODEL.F, MODEL.G):
        batch = function(x, u)
        assert batch.shape[: len(axes)] == axes
        for k in np.ndindex(axes):
            assert batch[k] == pytest.approx(function(x[k], u[k]), abs=1e-14)
    assert MODEL.M(u).shape == (*axes, 2, 2)


def test_one_input_moves_many():
    x = np.random.default_rng(2).uniform(-3, 3, (7, 3))
    u = np.array([1.5, 0.5])
    assert MODEL.f(x, u) == pytest.approx(np.array([MODEL.f(row, u) for row in x]))
    assert MODEL.F(x, u).shape == (7, 3, 3)
    assert MODEL.G(x, u).shape == (7, 3, 2)
