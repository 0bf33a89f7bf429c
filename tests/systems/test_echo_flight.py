"""The time of flight of an echo, and what it is measured against."""

import math

import numpy as np
import pytest
from numerics import definite

from ekfsim.models.sensors.echo import envelope
from ekfsim.simulation.bench import echoes, heard, sigma_of
from ekfsim.systems.echo import (
    SOUND,
    Pair,
    estimate_echo,
    flight_bound,
    height,
    highest,
    hilbert_envelope,
    noise_of,
    threshold_crossing,
    typical_delay,
    without_noise,
)

PAIR = Pair()


def envelopes(echo):
    return envelope(PAIR.times, *(echo[..., i, None] for i in range(4)))


def at(τ):
    """A typical echo that arrives at τ s."""
    A0, _, T, α = PAIR.typical
    return np.array([A0, τ, T, α])


def listened(n, snr, seed=1):
    """n echoes, their Hilbert envelopes and the noise in them."""
    echo = echoes(PAIR, n, np.random.default_rng([seed, 1]))
    samples = heard(PAIR, echo, sigma_of(snr), np.random.default_rng([seed, 2]))
    return echo, hilbert_envelope(samples), noise_of(samples, PAIR)


def rms(error):
    return math.sqrt(np.mean(error**2))


def test_the_document_s_numbers():
    assert (PAIR.carrier, PAIR.rate) == (40e3, 200e3)
    assert (PAIR.nearest, PAIR.farthest) == (0.1, 2.0)
    assert np.diff(PAIR.times) == pytest.approx(5e-6)
    assert PAIR.flight(1.0) == pytest.approx(2 / SOUND)
    last = envelope(PAIR.times, *(at(PAIR.flight(2.0))))
    assert last.max() == pytest.approx(1, abs=1e-3)
    assert last[-1] < 0.01


@pytest.mark.parametrize(("A0", "α"), [(2.0, 1.0), (0.7, 2.5)])
def test_height_is_the_envelope_s_highest_point(A0, α):
    s = np.linspace(0, 10, 100_001)
    assert height(A0, α) == pytest.approx(np.max(envelope(s, A0, 0.0, 1.0, α)), rel=1e-8)


def test_the_hilbert_envelope_of_an_echo_is_eq_38():
    echo = echoes(PAIR, 20, np.random.default_rng(0))
    difference = hilbert_envelope(PAIR.received(echo)) - envelopes(echo)
    assert np.abs(difference).max() < 0.03
    assert rms(difference) < 1.5e-3


def test_parameters_are_recovered_where_there_is_no_noise():
    """However far T and α are from what is typical: here by up to a third."""
    echo = echoes(PAIR, 40, np.random.default_rng(2))
    echo[:, 2] *= np.random.default_rng(3).uniform(0.8, 1.25, 40)
    echo[:, 0] *= np.geomspace(1e-3, 1e3, 40)
    found = estimate_echo(envelopes(echo), np.zeros(40), PAIR)
    np.testing.assert_allclose(found.mean, echo, rtol=1e-6)
    assert definite(found.covariance)


def test_a_batch_equals_its_runs():
    _, measured, sigma = listened(5, 20)
    x, P = estimate_echo(measured, sigma, PAIR)
    for i in range(5):
        x_one, P_one = estimate_echo(measured[i], sigma[i], PAIR)
        np.testing.assert_allclose(x_one, x[i], rtol=1e-9)
        np.testing.assert_allclose(P_one, P[i], rtol=1e-6)
        assert (
            threshold_crossing(measured[i], sigma[i], PAIR)
            == threshold_crossing(measured, sigma, PAIR)[i]
        )


@pytest.mark.parametrize("snr", [10, 20, 30])
def test_the_ukf_beats_the_threshold_and_stays_near_the_bound(snr):
    echo, measured, sigma = listened(200, snr)
    x, P = estimate_echo(measured, sigma, PAIR)
    error = x[:, 1] - echo[:, 1]
    late = threshold_crossing(measured, sigma, PAIR) - echo[:, 1]
    assert rms(error) < 0.8 * rms(late - typical_delay(PAIR)) < rms(late)
    bound = rms(flight_bound(echo, sigma_of(snr), PAIR))
    assert bound < rms(error) < 2 * bound
    assert 0.5 * rms(error) < np.sqrt(np.median(P[:, 1, 1])) < 1.2 * rms(error)


def test_a_louder_echo_is_an_echo_as_well_timed():
    _, measured, sigma = listened(3, 20)
    quiet, loud = (estimate_echo(k * measured, k * sigma, PAIR).mean for k in (1.0, 50.0))
    np.testing.assert_allclose(loud / quiet, np.broadcast_to([50.0, 1, 1, 1], (3, 4)), rtol=1e-9)


def test_silence_is_no_mistake():
    x, P = estimate_echo(np.zeros((2, len(PAIR.times))), np.full(2, 0.1), PAIR)
    assert np.isfinite(x).all()
    assert np.isfinite(P).all()


def test_noise_is_told_from_the_samples_before_any_echo():
    _, _, sigma = listened(300, 20)
    assert np.mean(sigma) == pytest.approx(sigma_of(20), rel=0.01)


def test_what_noise_lifts_is_taken_off_again():
    random = np.random.default_rng(0)
    true = 2.0 * np.ones((20, 5000))
    measured = np.hypot(true + random.normal(0, 0.3, true.shape), random.normal(0, 0.3, true.shape))
    assert np.mean(measured**2) == pytest.approx(4 + 2 * 0.09, rel=0.01)
    assert np.mean(without_noise(measured, np.full(20, 0.3)) ** 2) == pytest.approx(4, rel=0.01)


def test_the_highest_sample_is_at_the_peak():
    echo = at(4e-3)
    t = PAIR.times[highest(envelopes(echo), PAIR)]
    assert t == pytest.approx(4e-3 + PAIR.power * PAIR.rise, abs=0.2 * PAIR.rise)


@pytest.mark.parametrize("share", [0.1, 0.2, 0.5])
def test_a_typical_echo_is_timed_by_a_threshold_less_its_delay(share):
    echo = at(4.3217e-3)
    crossing = threshold_crossing(envelopes(echo), np.array(0.0), PAIR, share)
    assert crossing - typical_delay(PAIR, share) == pytest.approx(echo[1], abs=1e-6)


def test_the_bound_is_that_of_the_information_about_tau():
    """Against central differences of the envelope, in other units."""
    echo, sigma = at(4e-3), 0.05
    steps = np.diag(1e-5 * np.array([1, 1e-4, 1e-4, 1]))
    # per V, 0.1 ms, 0.1 ms, 1
    slopes = np.stack([(envelopes(echo + s) - envelopes(echo - s)) / 2e-5 for s in steps])
    known = np.diag([0, 0, (1e-4 / (0.1 * PAIR.rise)) ** 2, 1 / (0.1 * PAIR.power) ** 2])
    expected = math.sqrt(np.linalg.inv(slopes @ slopes.T / (2 * sigma**2) + known)[1, 1]) * 1e-4
    assert flight_bound(echo, sigma, PAIR) == pytest.approx(expected, rel=1e-3)
    assert flight_bound(np.stack([echo, echo]), sigma, PAIR).shape == (2,)
