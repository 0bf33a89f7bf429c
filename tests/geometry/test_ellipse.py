import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numerics import covariance
from scipy.stats import chi2, norm

from ekfsim.geometry.ellipse import (
    conditioned,
    cone_factor,
    cone_halfwidth,
    ellipse,
    outline,
    radius_factor,
)

K = math.sqrt(-2 * math.log(0.046))
spread = st.floats(1e-3, 100)
direction = st.floats(0, math.pi, exclude_max=True)
probability = st.floats(0.01, 0.999).filter(lambda p: p != 0.954)


def turned(major, minor, angle):
    """The covariance with these standard deviations along `angle` and across it."""
    c, s = math.cos(angle), math.sin(angle)
    R = np.array([[c, -s], [s, c]])
    return R @ np.diag([major**2, minor**2]) @ R.T


def test_the_factor_of_the_assignment():
    assert radius_factor(0.954) == pytest.approx(2.4816, abs=5e-5)
    assert cone_factor(0.954) == 2.0


@given(probability)
def test_the_factors_are_quantiles(p):
    assert radius_factor(p) ** 2 == pytest.approx(chi2.ppf(p, 2))
    assert cone_factor(p) == pytest.approx(norm.ppf((1 + p) / 2))


def test_the_factors_are_finite_up_to_the_largest_probability_below_one():
    largest = math.nextafter(1.0, 0.0)
    assert cone_factor(largest) == pytest.approx(norm.isf((1 - largest) / 2))
    assert radius_factor(largest) ** 2 == pytest.approx(chi2.isf(1 - largest, 2))


@given(spread, st.floats(0.01, 0.99), direction)
def test_radii_and_orientation_are_those_it_was_made_with(major, ratio, angle):
    drawn = ellipse(turned(major, ratio * major, angle), 0.954)
    assert drawn.major == pytest.approx(K * major, rel=1e-6)
    assert drawn.minor == pytest.approx(K * ratio * major, rel=1e-6)
    assert 0 <= drawn.orientation < math.pi
    assert math.remainder(float(drawn.orientation) - angle, math.pi) == pytest.approx(0, abs=1e-9)


@given(spread, st.floats(0, 1e-9), st.sampled_from([-1e-17, -1e-300, 0.0, 1e-300, 1e-17]))
def test_an_ellipse_along_x_has_orientation_zero_and_never_half_a_turn(major, minor, cross):
    drawn = ellipse(np.array([[major**2, cross], [cross, minor**2]]), 0.954)
    assert 0 <= drawn.orientation < math.pi
    assert math.sin(drawn.orientation) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("p", [0.5, 0.954, 0.99])
def test_it_holds_its_share_of_a_gaussian(p):
    random = np.random.default_rng(11)
    P = turned(0.7, 0.2, 2.1)
    e = random.multivariate_normal([0, 0], P, 200_000)
    drawn = ellipse(P, p)
    c, s = math.cos(drawn.orientation), math.sin(drawn.orientation)
    along, across = e @ [c, s], e @ [-s, c]
    share = np.mean((along / drawn.major) ** 2 + (across / drawn.minor) ** 2 <= 1)
    assert share == pytest.approx(p, abs=4 * math.sqrt(p * (1 - p) / len(e)))


@pytest.mark.parametrize("p", [0.5, 0.954])
def test_the_cone_holds_its_share_of_headings(p):
    e = np.random.default_rng(12).normal(0, 0.3, 200_000)
    share = np.mean(np.abs(e) <= cone_halfwidth(0.09, p))
    assert share == pytest.approx({0.5: 0.5, 0.954: 0.9545}[p], abs=0.005)


def test_no_width_is_no_radius():
    line = ellipse(np.array([[0.25, 0.25], [0.25, 0.25]]), 0.954)
    assert line.minor == 0
    assert line.major == pytest.approx(K * math.sqrt(0.5))
    assert line.orientation == pytest.approx(math.pi / 4)
    point = ellipse(np.zeros((2, 2)), 0.954)
    assert (float(point.major), float(point.minor)) == (0, 0)
    assert cone_halfwidth(0.0, 0.954) == 0
    assert cone_halfwidth(-1e-30, 0.954) == 0  # rounding


@pytest.mark.parametrize(
    "P", [-1e-15 * np.eye(2), np.array([[-1.83e-15, 1.79e-15], [1.79e-15, -1.75e-15]])]
)
def test_a_negative_rounding_error_is_no_radius(P):
    for drawn in (ellipse(P, 0.954), ellipse(P[None], 0.954)):
        assert 0 <= drawn.minor <= drawn.major < 1e-7
        assert 0 <= drawn.orientation < math.pi


def test_the_heading_changes_nothing():
    P = covariance(np.random.default_rng(13), 3)
    assert ellipse(P, 0.9) == ellipse(P[:2, :2], 0.9)


@pytest.mark.parametrize("axes", [(1,), (4,), (3, 2)])
def test_a_batch_equals_its_runs(axes):
    P = covariance(np.random.default_rng(14), *axes, 3)
    drawn = ellipse(P, 0.954)
    for k in np.ndindex(axes):
        one = ellipse(P[k], 0.954)
        for name in ("major", "minor", "orientation"):
            assert getattr(drawn, name)[k] == pytest.approx(float(getattr(one, name)), abs=1e-14)


def test_the_outline_lies_where_the_error_squared_is_k_squared():
    P, center = turned(0.7, 0.2, 2.1), np.array([3.0, -1.0])
    points = outline(center, P, 0.954)
    assert points.shape == (73, 2)
    assert points[0] == pytest.approx(points[-1])
    e = points - center
    assert np.vecdot(e, np.linalg.solve(P, e.T).T) == pytest.approx(radius_factor(0.954) ** 2)
    assert np.abs(e @ [math.cos(2.1), math.sin(2.1)]).max() == pytest.approx(
        float(ellipse(P, 0.954).major), rel=1e-2
    )


def test_conditioned_is_what_is_left_when_the_heading_is_known():
    """Of a large sample, those whose heading lies near the given offset."""
    P = np.array([[0.30, 0.10, 0.12], [0.10, 0.20, -0.08], [0.12, -0.08, 0.16]])
    offset = 0.5
    mean, left = conditioned(np.array([1.0, 2.0, 0.3]), P, offset)
    sample = np.random.default_rng(15).multivariate_normal([1.0, 2.0, 0.3], P, 1_000_000)
    near = sample[np.abs(sample[:, 2] - 0.8) < 0.01, :2]
    assert mean == pytest.approx(near.mean(axis=0), abs=0.015)
    assert left == pytest.approx(np.cov(near.T), abs=0.015)
    precision = np.linalg.inv(P)[:2, :2]
    assert left == pytest.approx(np.linalg.inv(precision))


def test_a_heading_that_tells_nothing_leaves_the_position_alone():
    x, block = np.array([1.0, 2.0, 0.3]), turned(0.7, 0.2, 2.1)
    for variance in (0.0, 0.5):
        P = np.zeros((3, 3))
        P[:2, :2], P[2, 2] = block, variance
        mean, left = conditioned(x, P, 0.4)
        assert mean == pytest.approx(x[:2])
        assert left == pytest.approx(block)
