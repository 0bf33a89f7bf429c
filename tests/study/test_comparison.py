"""Differences of pairs of runs, and their intervals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scenes import NOISE, scene

from ekfsim.commands import Move, Sense
from ekfsim.diagnostics.nees import error, nees
from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.localization import play
from ekfsim.study.block import run_block
from ekfsim.study.comparison import correlation, of_means, of_shares
from ekfsim.study.pairs import Pairs, Shared, Sums, run_pairs
from ekfsim.world import Noise


def scenes():
    """A run under true noise, and under a noise that the filter believes to be a third of it."""
    course = [c for k in range(8) for c in (Sense(0.7 * k), Move(0.4, 0.8))]
    a = scene(*course, sigma=(0.1, 0.1, 0.05), seed=5)
    small = Noise(*(value / 3 for value in vars(NOISE).values()))
    return a, replace(a, world=replace(a.world, told=replace(a.world.told, noise=small)))


def last(played, runs):
    """Errors and loss at the end of each run, counted run by run."""
    *_, step = play(played, np.arange(runs))
    e, measured = error(step.posterior, step.entry.truth), nees(step.posterior, step.entry.truth)
    bound = np.array([quantile(LOST, int(dof)) for dof in measured.dof])
    return (
        np.hypot(e[:, 0], e[:, 1]),
        np.abs(e[:, 2]),
        measured.impossible | (measured.value > bound),
    )


def test_the_pairs_are_the_runs_of_either_setting():
    a, b = scenes()
    found = run_pairs(a, b, 0, 300)
    (one, θ_one, lost_one), (other, θ_other, lost_other) = last(a, 300), last(b, 300)
    assert found.lost == Shared.of(lost_one, lost_other)
    assert found.lost.only_b > 10
    d = of_means(found.position)
    half = 1.959963984540054 * np.std(other - one, ddof=1) / math.sqrt(300)
    mean = np.mean(other - one)
    assert_allclose(d, [np.mean(one), np.mean(other), mean, mean - half, mean + half], rtol=1e-9)
    assert of_means(found.heading).value == pytest.approx(np.mean(θ_other - θ_one))
    assert (found.position.b_less, found.position.a_less) == (
        np.sum(other < one),
        np.sum(other > one),
    )
    for side, played in ((found.a, a), (found.b, b)):
        assert repr(side.plain()) == repr(run_block(played, 0, 300).plain())
    assert sum(found.a_errors.values()) == sum(found.b_errors.values()) == 300


def test_blocks_put_together_are_the_whole():
    a, b = scenes()
    whole = run_pairs(a, b, 0, 200)
    both: Pairs = run_pairs(a, b, 0, 120) + run_pairs(a, b, 120, 80)
    assert both.lost == whole.lost
    assert both.inside == whole.inside
    assert_allclose(both.position, whole.position)
    assert_allclose(both.heading, whole.heading)
    assert both.a_errors == whole.a_errors
    assert both.a.runs == 200


def test_a_setting_that_changes_nothing_differs_in_nothing():
    a, _ = scenes()
    found = run_pairs(a, replace(a, guard="off"), 0, 100)
    assert found.lost.only_a == found.lost.only_b == 0
    assert of_means(found.position)[2:] == (0.0, 0.0, 0.0)
    assert not of_shares(found.lost).clear


def test_the_interval_of_a_paired_difference_holds_it_95_times_in_100():
    """Many tables are drawn with known shares, correlated as runs on the same draws are, and rare
    as losses are."""
    rng = np.random.default_rng(11)
    for p in ([0.05, 0.01, 0.04, 0.90], [0.002, 0.001, 0.006, 0.991], [0.5, 0.2, 0.1, 0.2]):
        true = p[2] - p[1]
        # of few runs with few losses it holds more
        for runs, most in ((300, 1.0), (10_000, 0.965)):
            tables = rng.multinomial(runs, p, size=2000).tolist()
            held = [
                d.low <= true <= d.high for d in (of_shares(Shared(*table)) for table in tables)
            ]
            assert 0.94 <= np.mean(held) <= most


def test_the_interval_is_newcombes():
    """The first line of his table of examples (Statistics in Medicine 17, 1998, 2635): 0.0569 to
    0.3404."""
    assert of_shares(Shared(36, 2, 12, 0))[2:] == pytest.approx((0.2, 0.0569, 0.3404), abs=5e-5)


def test_the_correlation_is_corrected_for_continuity():
    assert correlation(Shared(30, 3, 5, 12)) == pytest.approx(
        (360 - 15 - 25) / math.sqrt(33 * 17 * 35 * 15)
    )
    assert correlation(Shared(3, 30, 12, 5)) == pytest.approx(
        (15 - 360) / math.sqrt(33 * 17 * 15 * 35)
    )
    assert correlation(Shared(3, 2, 2, 3)) == 0.0


@pytest.mark.parametrize(
    "table",
    [(0, 0, 0, 50), (50, 0, 0, 0), (0, 0, 50, 0), (0, 50, 0, 0), (3, 0, 0, 47), (0, 1, 0, 0)],
)
def test_shares_of_0_and_1_have_intervals_too(table):
    d = of_shares(Shared(*table))
    assert -1 - 1e-12 <= d.low < d.high <= 1 + 1e-12
    assert d.low <= d.value <= d.high


def test_a_and_b_in_each_others_place_turn_the_signs():
    one, other = of_shares(Shared(5, 2, 9, 84)), of_shares(Shared(5, 9, 2, 84))
    assert_allclose([other.value, other.low, other.high], [-one.value, -one.high, -one.low])
    assert one.value == pytest.approx(0.07)


def test_of_no_runs_and_of_one_nothing_is_known():
    assert all(map(math.isnan, of_shares(Shared(0, 0, 0, 0))))
    assert all(map(math.isnan, of_means(Sums.of(np.array([np.nan]), np.array([1.0])))))
    d = of_means(Sums.of(np.array([1.0]), np.array([3.0])))
    assert d[:3] == (1.0, 3.0, 2.0)
    assert math.isnan(d.low)
    assert not d.clear
