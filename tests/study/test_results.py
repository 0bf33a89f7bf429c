"""Shares, bands and words: what is said of the counts."""

import math

import numpy as np
import pytest
from scipy import stats

from ekfsim.study.counting import IMPOSSIBLE
from ekfsim.study.results import Mean, Result, Share
from ekfsim.study.tally import AtSteps, Bin, Extreme, OfRuns, Tally
from ekfsim.study.verdict import Word, proven, verdict, word_at


@pytest.mark.parametrize(("runs", "of"), [(0, 10), (1, 10), (5, 10), (10, 10), (3, 1000), (997, 1000), (1, 1)])
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
    assert (mean.low, mean.high) == pytest.approx(tuple(stats.chi2.ppf([0.025, 0.975], 3000) / 1000))
    millions = Mean.of(4.5e7, 45_000_000, 45_000_000)
    assert (millions.low, millions.high) == pytest.approx(
        tuple(1 + np.array([-1, 1]) * stats.norm.ppf(0.975) * math.sqrt(2 / 4.5e7)), rel=1e-6
    )


def result(above=(500,), ellipse=(954,), lost_from=None, runs=1000, ellipse_runs=None, **more):
    """A result of so many runs a step, everything else as it should be."""
    k = len(above)
    full, none = np.full(k, runs), np.zeros(k, np.int64)
    drawn = full if ellipse_runs is None else ellipse_runs
    at = AtSteps(
        judged=more.get("judged", full), impossible=none, above_50=np.array(above), above_95=full // 20,
        above_999=full // 1000, in_ellipse=np.array(ellipse), ellipse_runs=drawn,
        in_cone=full, cone_runs=full, nees_runs=full, nees_dof=3 * full, nees_sum=3.0 * full,
        position_square=0.01 * full, heading_square=0.0004 * full,
    )  # fmt: skip
    spread = more.get("spread", {0: Bin(runs, 0)})
    worst = Extreme(False, 9.0, 7)
    return Result(None, Tally(runs, np.arange(k), np.full(k, np.nan), at, OfRuns(), lost_from or {}, spread, worst))


@pytest.mark.parametrize(
    ("made", "word"),
    [
        ({}, Word.CONSISTENT),
        ({"above": (450,)}, Word.CONSISTENT),
        ({"above": (550,)}, Word.CONSISTENT),
        ({"above": (551,)}, Word.OVER_CONFIDENT),
        ({"above": (449,)}, Word.OVER_CAUTIOUS),
        ({"ellipse": (921,)}, Word.CONSISTENT),  # 92.1 %, its interval reaches 93.6 %
        ({"ellipse": (915,)}, Word.OVER_CONFIDENT),
        ({"ellipse": (981,)}, Word.CONSISTENT),
        ({"ellipse": (990,)}, Word.OVER_CAUTIOUS),
        ({"lost_from": {0: 19}}, Word.CONSISTENT),
        ({"lost_from": {0: 20}}, Word.OVER_CONFIDENT),
        ({"above": (300,), "lost_from": {0: 20}}, Word.OVER_CONFIDENT),
        ({"ellipse": (0,), "ellipse_runs": np.array([0])}, Word.CONSISTENT),
        ({"judged": np.array([0]), "above": (0,)}, Word.NO_EVIDENCE),
    ],
)
def test_the_rule(made, word):
    assert word_at(result(**made).last) is word


def test_a_verdict_tells_since_when_without_a_gap():
    found = verdict(result(above=(600, 500, 560, 570, 600), ellipse=(954,) * 5))
    assert (found.word, found.since.step) == (Word.OVER_CONFIDENT, 2)
    found = verdict(result(above=(500, 700, 400, 440), ellipse=(954,) * 4))
    assert (found.word, found.since.step) == (Word.OVER_CAUTIOUS, 2)
    found = verdict(result(above=(700, 700, 500), ellipse=(954,) * 3))
    assert (found.word, found.since) == (Word.CONSISTENT, None)
    found = verdict(result(above=(500, 500, 500), ellipse=(954,) * 3, lost_from={0: 15, 1: 5}))
    assert (found.word, found.since.step) == (Word.OVER_CONFIDENT, 1)


def test_what_its_interval_still_allows_is_not_proven():
    assert proven(result().last)
    assert not proven(result().last._replace(above_50=Share(100, 200)))  # consistent, of few runs
    assert proven(result(above=(600,)).last)
    assert not proven(result(above=(555,)).last)
    assert not proven(result(above=(445,)).last)
    assert proven(result(ellipse=(900,)).last)
    assert not proven(result(lost_from={0: 21}).last)
    assert proven(result(lost_from={0: 40}).last)


def test_lost_are_those_that_are_lost_from_a_step_or_an_earlier_one():
    made = result(above=(500,) * 4, ellipse=(954,) * 4, lost_from={1: 3, 3: 4})
    assert [at.lost.runs for at in made.steps] == [0, 3, 3, 7]
    assert made.lost_from == 3
    assert result(above=(500,) * 4, ellipse=(954,) * 4, lost_from={1: 3, 3: 3}).lost_from == 1
    assert result().lost_from is None


def test_errors_are_roots_of_mean_squares():
    last = result().last
    assert (last.position_rmse, last.heading_rmse) == pytest.approx((0.1, 0.02))


def test_the_typical_run_is_the_first_of_those_in_the_middle():
    made = result(runs=10, above=(5,), ellipse=(9,), spread={-3: Bin(4, 2), 5: Bin(1, 9), 40: Bin(5, 0)})
    assert made.typical == 9
    mostly_impossible = {0: Bin(4, 0), IMPOSSIBLE: Bin(6, 3)}
    assert result(runs=10, above=(5,), ellipse=(9,), spread=mostly_impossible).typical == 3
