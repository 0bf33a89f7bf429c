"""What printed digits leave open, against all that may have stood behind them."""

import numpy as np
import pytest

from ekfsim.filters.belief import Gaussian
from ekfsim.student.printed.digits import Digits, Halves, carried

SIX = [f"{value:.6g}" for value in (0.0123456789, 0.123456789, 1.23456789, 12.3456789, 123.456789)]
FIXED = [f"{float(text):.4f}" for text in SIX]


@pytest.mark.parametrize("style", ["{:.6g}", "{:.4f}", "{:.3e}", "{:.17g}", "round"])
def test_no_half_is_less_than_what_was_cut_off(style):
    """Over ten powers of ten, whatever zeros are left out."""
    random = np.random.default_rng(5)
    values = (random.standard_normal(400) * 10.0 ** random.integers(-5, 5, 400)).tolist()
    values += [0.5, 0.25, 90.0, 100.0, 0.0, 1.0, 20.0, 1e-4]
    texts = [str(round(v, 4)) if style == "round" else style.format(v) for v in values]
    digits = Digits.of(texts)
    for value, text in zip(values, texts, strict=True):
        assert abs(value - float(text)) <= digits.half(float(text)) * (1 + 1e-9) + 1e-16 * abs(
            value
        )


@pytest.mark.parametrize(("texts", "digits"), [(SIX, 6), (FIXED, 4)])
def test_a_half_is_no_more_than_ten_times_what_may_be_cut_off(texts, digits):
    halves = Digits.of(texts)
    for text in texts:
        value = float(text)
        finest = 10.0 ** -(digits if texts is not SIX else digits - 1 - np.floor(np.log10(value)))
        assert finest / 2 * (1 - 1e-9) <= halves.half(value) <= finest * 5 * (1 + 1e-9)


def test_a_column_of_bare_zeros_is_exact():
    assert Digits.of(["0", "0"]).half(0.0) == 0.0
    assert Digits.of(["0.00", "0.00"]).half(0.0) == 0.005


def test_what_is_carried_holds_every_belief_that_may_have_been_printed():
    """A step that mixes all entries, from 500 beliefs within the halves."""
    random = np.random.default_rng(7)
    A = random.standard_normal((3, 3))

    def step(belief):
        x, P = belief
        return Gaussian(np.tanh(A @ x) + P @ x, A @ P @ A.T + np.outer(x, x) * P[0, 1])

    spread = random.standard_normal((3, 3))
    belief = Gaussian(random.standard_normal(3), spread @ spread.T)
    halves = Halves(np.full(3, 1e-5), np.full((3, 3), 2e-5))
    found, base = carried(step, belief, halves, ()), step(belief)
    most_x, most_P = np.zeros(3), np.zeros((3, 3))
    for _ in range(500):
        P = random.uniform(-2e-5, 2e-5, (3, 3))
        P = np.triu(P) + np.triu(P, 1).T
        other = step(Gaussian(belief.mean + random.uniform(-1e-5, 1e-5, 3), belief.covariance + P))
        most_x = np.maximum(most_x, np.abs(other.mean - base.mean))
        most_P = np.maximum(most_P, np.abs(other.covariance - base.covariance))
    assert np.all(most_x <= found.x * 1.001)
    assert np.all(most_P <= found.P * 1.001)
    assert np.all(20 * most_x >= found.x)
    assert np.all(20 * most_P >= found.P)


def test_a_heading_is_carried_round_the_circle():
    def step(belief):
        θ = belief.mean[0] + 3e-6
        return Gaussian(np.array([(θ + np.pi) % (2 * np.pi) - np.pi]), belief.covariance)

    belief = Gaussian(np.array([np.pi - 4e-6]), np.zeros((1, 1)))
    found = carried(step, belief, Halves(np.array([5e-6]), np.zeros((1, 1))), (0,))
    assert found.x == pytest.approx(5e-6, rel=1e-6)
