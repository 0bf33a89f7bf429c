import numpy as np
import pytest
from scipy.stats import chi2

from ekfsim.diagnostics.verdict import Evidence, Verdict, lost
from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.records import Entry, Nees, Step

ORIGIN = np.zeros(3)


def measured(value, dof=3, impossible=False):
    return Nees(np.array(value), np.array(dof), np.array(impossible))


def test_lost_is_beyond_the_last_thousandth_or_impossible():
    bound = chi2.ppf(0.999, 3)
    assert not lost(measured(bound * 0.9999))
    assert lost(measured(bound * 1.0001))
    assert lost(measured(chi2.ppf(0.999, 1) * 1.0001, dof=1))
    assert lost(measured(np.nan, dof=2, impossible=True))
    assert not lost(measured(0.0, dof=0))


BELIEF = Gaussian(ORIGIN, np.eye(3))
FINE, BAD = measured(1.0), measured(99.0)


def step(index, nees=None, nis=None):
    one = np.ones((1, 1))
    correction = (
        None
        if nis is None
        else Correction(one[0], one[0], one, one, one, one, np.array(nis), np.array(0))
    )
    return Step(Entry(index, None), BELIEF, BELIEF, correction=correction, nees=nees)


def evidence(*steps):
    gathered = Evidence()
    for one in steps:
        gathered.add(one)
    return gathered


@pytest.mark.parametrize(
    ("course", "since"),
    [
        ([FINE, FINE], None),
        ([BAD, BAD, BAD], 0),
        ([FINE, BAD, FINE, BAD, BAD], 3),
        ([BAD, BAD, FINE], None),
        ([FINE, BAD, None, BAD], 1),  # where the truth is not known nothing is said
        ([FINE, measured(np.nan, 1, True)], 1),
    ],
)
def test_lost_from_a_step_on_means_without_a_gap_to_the_end(course, since):
    gathered = evidence(*(step(i, nees) for i, nees in enumerate(course)))
    assert gathered.lost_from == since
    assert (gathered.verdict is Verdict.LOST) == (since is not None)


def of_sum(nis, n, last=None):
    return evidence(*(step(i, last, nis / n) for i in range(n))).verdict


@pytest.mark.parametrize("n", [1, 4, 100])
def test_the_verdict_by_the_sum_of_nis(n):
    low, high = chi2.interval(0.99, n)
    assert of_sum(high * 1.0001, n) is Verdict.OVER_CONFIDENT
    assert of_sum(high * 0.9999, n) is Verdict.CONSISTENT
    assert of_sum(low * 1.0001, n) is Verdict.CONSISTENT
    assert of_sum(low * 0.9999, n) is Verdict.OVER_CAUTIOUS
    assert of_sum(high * 2, n, BAD) is Verdict.LOST
    assert of_sum((low + high) / 2, n, FINE) is Verdict.CONSISTENT


def test_without_an_update_there_is_no_evidence():
    assert evidence(step(0, FINE), step(1, FINE)).verdict is Verdict.NO_EVIDENCE
    assert evidence(step(0, FINE), step(1, FINE, np.nan)).verdict is Verdict.NO_EVIDENCE
    assert evidence(step(0, BAD)).verdict is Verdict.LOST


def test_the_words():
    assert {verdict.value for verdict in Verdict} == {
        "lost", "over-confident", "over-cautious", "consistent", "no evidence"
    }  # fmt: skip
