"""The least cost and its intervals, of costs whose own are known in closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

from ekfsim.fitting.estimate import risen
from ekfsim.fitting.search import ends, lowest

RISE = 1.92


def of_a_sample(points):
    """−ln p of 12 numbers of mean square 4, by the logarithm of their σ."""
    σ = np.exp(points[:, 0])
    return 12 * np.log(σ) + 12 * 4 / (2 * σ**2)


def test_of_a_sample_the_root_mean_square_is_found_and_the_interval_of_its_likelihood():
    best = lowest(of_a_sample, np.array([3.0]), 9.0)
    assert np.exp(best.at) == pytest.approx([2.0], rel=1e-2)
    (down, up), _ = ends(of_a_sample, best, RISE, (4.0, 7.0))
    risen = lambda x: of_a_sample(np.array([[x]]))[0] - best.cost - RISE  # noqa: E731
    assert (down.done, down.open, up.done, up.open) == (True, False, True, False)
    assert down.at[0] == pytest.approx(brentq(risen, -1, np.log(2)), abs=0.01)
    assert up.at[0] == pytest.approx(brentq(risen, np.log(2), 3), abs=0.01)


def sum_of_two(points):
    """20 numbers of variance a² + b², mean square 5, and 8 of variance a² alone, mean square 1."""
    a, b = np.exp(2 * points).T
    return 10 * (np.log(a + b) + 5 / (a + b)) + 4 * (np.log(a) + 1 / a)


def profile(x, i, of=sum_of_two):
    """The least cost where the number i is exp(x), by scipy."""
    point = lambda y: np.insert([float(y)], i, x)[None]  # noqa: E731
    found = minimize(lambda y: of(point(y[0]))[0], [0.5], method="Nelder-Mead", tol=1e-9)
    return found.fun


def test_an_end_lets_the_other_numbers_follow():
    best = lowest(sum_of_two, np.log([3.0, 0.5]), 9.0)
    assert np.exp(2 * best.at) == pytest.approx([1.0, 4.0], rel=0.02)
    for end in ends(sum_of_two, best, RISE, (4.0, 7.0))[0]:
        assert end.done
        assert not end.open
        assert profile(end.at[end.i], end.i) - best.cost == pytest.approx(RISE, abs=0.03)
        assert end.way * (end.at[end.i] - best.at[end.i]) > 0


def test_where_a_number_may_be_nothing_its_lower_end_is_open():
    """Both kinds of numbers are as large as each other: b may well be 0."""

    def alike(points):
        a, b = np.exp(2 * points).T
        return 10 * (np.log(a + b) + 1.02 / (a + b)) + 10 * (np.log(a) + 1 / a)

    best = lowest(alike, np.log([3.0, 0.5]), 9.0)
    (a_down, a_up, b_down, b_up), _ = ends(alike, best, RISE, (4.0, 7.0))
    assert b_down.open
    for end in (a_down, a_up, b_up):
        assert not end.open
        assert profile(end.at[end.i], end.i, alike) - best.cost == pytest.approx(RISE, abs=0.03)


def test_the_fewer_were_read_the_farther_out_an_interval_ends():
    """Half of the square of Student's t: 12.706, 2.228 and 1.972 in any table."""
    for read, t in ((2, 12.706), (11, 2.228), (201, 1.972)):
        assert risen(read, 1) == pytest.approx(t * t / 2, rel=1e-3)
