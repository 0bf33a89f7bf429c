"""Shares, bands and words: what is said of the counts."""

import math

import numpy as np
import pytest
from counted import counted
from scipy import stats

from ekfsim.study.counting import IMPOSSIBLE
from ekfsim.study.results import Mean, Share
from ekfsim.study.tally import Bin


@pytest.mark.parametrize(
    ("runs", "of"), [(0, 10), (1, 10), (5, 10), (10, 10), (3, 1000), (997, 1000), (1, 1)]
)
def test_the_interval_is_wilsons(runs, of):
    share = Share(runs, of)
    wanted = stats.binomtest(runs, of).proportion_ci(0.95, method="wilson")
    assert share.value == runs / of
    assert (share.low, share.high) == pytest.approx((wanted.low, wanted.high), abs=1e-12)


def test_of_no_runs_there_is_no_share():
    share = Share(0, 0)
    assert all(map(math.isnan, (share.value, share.low, share.high)))
    assert all(map(math.isnan, Mean.of(0.0, 0, 0)))


def test_a_mean_has_the_band_of_chi_square():
    mean = Mean.of(3100.0, 3000, 1000)
    assert mean.value == 3.1
    assert (mean.low, mean.high) == pytest.approx(
        tuple(stats.chi2.ppf([0.025, 0.975], 3000) / 1000)
    )
    millions = Mean.of(4.5e7, 45_000_000, 45_000_000)
    assert (millions.low, millions.high) == pytest.approx(
        tuple(1 + np.array([-1, 1]) * stats.norm.ppf(0.975) * math.sqrt(2 / 4.5e7)), rel=1e-6
    )


def test_lost_are_those_that_are_lost_from_a_step_or_an_earlier_one():
    made = counted(above=(500,) * 4, ellipse=(954,) * 4, lost_from={1: 3, 3: 4})
    assert [at.lost.runs for at in made.steps] == [0, 3, 3, 7]
    assert made.lost_from == 3
    assert counted(above=(500,) * 4, ellipse=(954,) * 4, lost_from={1: 3, 3: 3}).lost_from == 1
    assert counted().lost_from is None


def test_errors_are_roots_of_mean_squares():
    last = counted().last
    assert (last.position_rmse, last.heading_rmse) == pytest.approx((0.1, 0.02))


def test_the_typical_run_is_the_first_of_those_in_the_middle():
    made = counted(
        runs=10, above=(5,), ellipse=(9,), spread={-3: Bin(4, 2), 5: Bin(1, 9), 40: Bin(5, 0)}
    )
    assert made.typical == 9
    mostly_impossible = {0: Bin(4, 0), IMPOSSIBLE: Bin(6, 3)}
    assert counted(runs=10, above=(5,), ellipse=(9,), spread=mostly_impossible).typical == 3
