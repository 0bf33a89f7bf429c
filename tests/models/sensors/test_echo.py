import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numerics import jacobian

from ekfsim.diagnostics.ambiguity import remark
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.models.motions.constant import Constant
from ekfsim.models.sensors.echo import Echo, envelope

TIMES = np.linspace(0, 5, 101)  # ms
ECHO = Echo(TIMES, 0.02)
wild = st.one_of(
    st.floats(-1e6, 1e6), st.sampled_from([0.0, -0.0, 1e-300, -1e-300, 1e-12, 2e-12, 500.0, -500.0])
)


def drawn(random, axes=()):
    """A₀, τ, T, α of echoes that start between two samples."""
    τ = random.integers(10, 60, axes) * 0.05 + 0.025
    return np.stack(
        [
            random.uniform(0.5, 2, axes),
            τ,
            random.uniform(0.2, 0.6, axes),
            random.uniform(1, 3, axes),
        ],
        axis=-1,
    )


def test_it_rises_after_the_time_of_flight_and_is_highest_a_little_later():
    t = np.linspace(0, 10, 10_001)
    A = envelope(t, 2.0, 1.5, 0.4, 2.5)
    assert not A[t <= 1.5].any()
    assert (A[t > 1.501] > 0).all()
    assert t[A.argmax()] == pytest.approx(1.5 + 2.5 * 0.4, abs=1e-3)
    assert A[-1] < 1e-4


@pytest.mark.parametrize("seed", range(20))
def test_H_equals_central_differences(seed):
    x = drawn(np.random.default_rng(seed))
    h, H, R = ECHO.linearize(x)
    np.testing.assert_allclose(H, jacobian(ECHO.h, x), atol=1e-6, rtol=1e-5)
    np.testing.assert_array_equal(h, ECHO.h(x))
    assert np.array_equal(R, 0.02**2 * np.eye(101))
    assert len(ECHO.outputs) == 101
    assert remark(ECHO, x, np.eye(4)) is None


@pytest.mark.parametrize("axes", [(1,), (9,), (3, 2)])
def test_a_batch_equals_its_runs(axes):
    x = drawn(np.random.default_rng(1), axes)
    batch = ECHO.linearize(x)
    assert [values.shape for values in batch] == [(*axes, 101), (*axes, 101, 4), (*axes, 101, 101)]
    for k in np.ndindex(axes):
        for values, alone in zip(batch, ECHO.linearize(x[k]), strict=True):
            np.testing.assert_allclose(values[k], alone, atol=1e-13)


@given(wild, wild, wild, wild)
def test_no_parameters_break_it(A0, τ, T, α):
    for values in ECHO.linearize(np.array([A0, τ, T, α])):
        assert np.isfinite(values).all()


def test_an_echo_that_cannot_rise_is_none():
    for T in (0.0, -0.3):
        h, H, _ = ECHO.linearize(np.array([1.0, 1.0, T, 2.0]))
        assert not h.any()
        assert not H.any()


def test_parameters_stay_but_for_their_noise():
    motion, x = Constant(np.diag([1.0, 2, 3, 4])), np.array([1.0, 2, 3, 4])
    for state in (x, np.stack([x, 2 * x])):
        f, F, G, M, Q = motion.linearize(state, np.zeros(0))
        np.testing.assert_array_equal(f, state)
        np.testing.assert_array_equal(F, np.broadcast_to(np.eye(4), F.shape))
        assert F.shape == (*state.shape, 4)
        assert not (G @ M @ G.mT).any()
        assert np.array_equal(Q, motion.Q(np.zeros(0)))
    posterior, _ = EKF(headings=()).predict(Gaussian(x, np.eye(4)), motion, np.zeros(0))
    np.testing.assert_array_equal(posterior.mean, x)
    np.testing.assert_array_equal(posterior.covariance, np.diag([2.0, 3, 4, 5]))


def test_a_filter_finds_the_parameters_of_an_echo():
    truth, random = np.array([1.2, 1.83, 0.35, 2.2]), np.random.default_rng(1)
    z = ECHO.h(truth) + random.normal(0, 0.02, 101)
    belief = Gaussian(np.array([1.0, 1.75, 0.4, 2.0]), np.diag([0.3, 0.1, 0.1, 0.3]) ** 2)
    for _ in range(5):
        belief, _ = EKF(headings=()).predict(belief, Constant(np.eye(4) * 1e-6), np.zeros(0))
        belief, _ = EKF(headings=()).update(belief, ECHO, z)
    assert belief.mean[1] == pytest.approx(1.83, abs=0.05)
