import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numerics import covariance
from scipy.stats import chi2

from ekfsim.consistency import (
    Evidence,
    Verdict,
    error,
    inside_cone,
    inside_ellipse,
    lost,
    nees,
    squared_error,
)
from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.filters.chi_square import band, quantile
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.records import Entry, Nees, Step

seeds = st.integers(0, 2**32 - 1)
ORIGIN = np.zeros(3)


def judge(P, e):
    return nees(Gaussian(np.array(e, float), np.array(P, float)), ORIGIN[: len(e)])


def value(P, e):
    judged = judge(P, e)
    assert not judged.impossible
    return float(judged.value)


def impossible(P, e):
    judged = judge(P, e)
    assert np.isnan(judged.value) == judged.impossible
    return bool(judged.impossible)


@given(seeds)
def test_nees_of_a_full_covariance(seed):
    random = np.random.default_rng(seed)
    P, e = covariance(random, 3) + 0.1 * np.eye(3), random.normal(size=3)
    assert value(P, e) == pytest.approx(e @ np.linalg.solve(P, e), rel=1e-9)
    assert judge(P, e).dof == 3


@given(seeds, st.integers(1, 2))
def test_nees_of_a_singular_covariance_is_that_of_the_pseudoinverse(seed, rank):
    random = np.random.default_rng(seed)
    A = np.linalg.qr(random.normal(size=(3, 3)))[0][:, :rank] * random.uniform(0.2, 2, rank)
    P, e = A @ A.T, A @ random.uniform(-1, 1, rank)
    assert value(P, e) == pytest.approx(e @ np.linalg.pinv(P, rcond=1e-10) @ e, rel=1e-8)
    assert judge(P, e).dof == rank


def test_nees_of_a_certain_belief():
    assert judge(np.zeros((3, 3)), [0, 0, 0]).dof == 0
    assert value(np.zeros((3, 3)), [0, 0, 0]) == 0
    assert impossible(np.zeros((3, 3)), [1.1e-6, 0, 0])
    assert not impossible(np.zeros((3, 3)), [0.9e-6, 0, 0])
    assert impossible(np.zeros((3, 3)), [0, 0, -1.1e-6])


def test_nees_of_one_and_of_two_directions():
    line = np.outer([3, 4, 0], [3, 4, 0]) / 25 * 0.04  # σ 0.2 along (3, 4)
    assert value(line, [0.6, 0.8, 0]) == pytest.approx(25)
    assert judge(line, [0.6, 0.8, 0]).dof == 1
    assert impossible(line, [0.6, 0.8, 1.1e-6])
    assert impossible(line, [-0.8e-5, 0.6e-5, 0])
    assert not impossible(line, [0.6, 0.8, 0.9e-6])
    plane = np.diag([0.04, 0, 0.01])
    assert value(plane, [0.2, 0, 0.3]) == pytest.approx(1 + 9)
    assert judge(plane, [0.2, 0, 0.3]).dof == 2
    assert impossible(plane, [0.2, 2e-6, 0.3])


@pytest.mark.parametrize("degrees", [90, 180, 45, -90, 90 + 1e-9, 90 + 1e-5, 90 + 1e-3])
@pytest.mark.parametrize("axes", [(), (1,)])
def test_a_straight_way_in_any_direction(degrees, axes):
    """Due north P_xx is not 0 but (6e-17 σ)², and counts for nothing."""
    heading = math.radians(degrees)
    way = np.array([math.cos(heading), math.sin(heading), 0.0])
    P = np.broadcast_to(np.outer(way, way) * 0.04, (*axes, 3, 3))
    for e in (0.3 * way, np.round(0.3 * way, 12)):
        judged = nees(Gaussian(np.broadcast_to(e, (*axes, 3)), P), ORIGIN)
        assert judged.value == pytest.approx(2.25, rel=1e-9)
        assert judged.dof == 1
        assert not judged.impossible


@pytest.mark.parametrize("left", [0.9e-12, 1e-18])
def test_what_rounding_leaves_of_a_variance_is_none(left):
    for P, dof in ((np.diag([left**2, 0.04, 0]), 1), (np.diag([left**2, 0.04, 0.01]), 2)):
        assert judge(P, [1e-9, 0.2, 0]).dof == dof
        assert value(P, [1e-9, 0.2, 0]) == pytest.approx(1)
        assert impossible(P, [1.1e-6, 0.2, 0])
    assert judge(np.diag([1.1e-12**2, 0.04, 0.01]), [0, 0.2, 0]).dof == 3


def test_a_heading_that_moves_the_position_too():
    """The end of a straight way whose heading was uncertain: y = 5 θ. One degree of freedom, both
    errors or none."""
    P = 0.01**2 * np.array([[0, 0, 0], [0, 25, 5], [0, 5, 1.0]])
    assert judge(P, [0, 0.1, 0.02]).dof == 1
    assert value(P, [0, 0.1, 0.02]) == pytest.approx(4)
    assert impossible(P, [0, 0.1, 0.0])


@given(seeds, st.floats(-4, 4))
def test_neither_metres_nor_radians_decide(seed, power):
    random = np.random.default_rng(seed)
    P, e, scale = (
        covariance(random, 3) + 0.1 * np.eye(3),
        random.normal(size=3),
        np.array([10**power, 1, 1]),
    )
    assert value(P * np.outer(scale, scale), e * scale) == pytest.approx(value(P, e), rel=1e-8)
    assert judge(P * np.outer(scale, scale), e * scale).dof == 3


@pytest.mark.parametrize("tiny", [1e-4, 1e-6, 1e-8])
def test_a_small_but_honest_variance_counts(tiny):
    assert judge(np.diag([1, 1, tiny**2]), [0, 0, tiny]).dof == 3
    assert value(np.diag([1, 1, tiny**2]), [0, 0, 2 * tiny]) == pytest.approx(4)


def test_the_rank_is_counted_where_all_variances_are_one():
    for excess, rank in ((0.9e-10, 1), (1.1e-10, 2)):
        P = np.array([[1, 1 - excess], [1 - excess, 1]])  # eigenvalues `excess` and 2 − `excess`
        assert squared_error(np.array([0.1, 0.1]), P)[1] == rank
        assert squared_error(np.array([[0.1, 0.1]]), P[None])[1] == rank


@settings(max_examples=8)
@given(seeds)
def test_nees_of_errors_drawn_from_the_covariance_is_chi_square(seed):
    random = np.random.default_rng(seed)
    for rank in (1, 2, 3):
        A = 0.2 * random.normal(size=(3, rank))  # so that no heading is out by half a turn
        e = random.normal(size=(4000, rank)) @ A.T
        judged = nees(Gaussian(e, np.broadcast_to(A @ A.T, (4000, 3, 3))), ORIGIN)
        if judged.dof[0] == rank and np.linalg.cond(A) < 1e3:
            assert not judged.impossible.any()
            assert np.mean(judged.value) == pytest.approx(rank, abs=6 * math.sqrt(2 * rank / 4000))


@pytest.mark.parametrize("axes", [(1,), (6,), (3, 2)])
def test_a_batch_equals_its_runs(axes):
    random = np.random.default_rng(2)
    P = covariance(random, *axes, 3)
    P[..., 2, :] = P[..., :, 2] = 0
    P.reshape(-1, 3, 3)[::2, 2, 2] = 0.5  # ranks of 2 and 3 side by side
    e = random.normal(size=(*axes, 3)) * [1, 1, 0.1]
    judged = nees(Gaussian(e, P), np.zeros((*axes, 3)))
    for k in np.ndindex(axes):
        one = judge(P[k], e[k])
        assert judged.value[k] == pytest.approx(float(one.value), rel=1e-9, nan_ok=True)
        assert (judged.dof[k], judged.impossible[k]) == (one.dof, one.impossible)


@given(seeds, st.floats(-9, 0))
def test_one_belief_is_judged_as_in_a_batch(seed, power):
    """Whether clearly of full rank, or nearly singular."""
    random = np.random.default_rng(seed)
    P = covariance(random, 3, rank=2) + 10**power * np.eye(3)
    e = np.linalg.cholesky(P) @ random.uniform(-1, 1, 3)
    one, batch = squared_error(e, P), squared_error(e[None], P[None])
    assert float(one[0]) == pytest.approx(float(batch[0][0]), rel=1e-4 if power < -4 else 1e-9)
    assert (int(one[1]), bool(one[2])) == (int(batch[1][0]), bool(batch[2][0]))


def test_errors_of_headings_go_the_short_way_round():
    belief = Gaussian(np.array([1.0, 2.0, 3.1]), np.eye(3))
    assert error(belief, np.array([0.5, 2.5, -3.1])) == pytest.approx(
        [0.5, -0.5, 6.2 - 2 * math.pi]
    )
    assert belief.mean[2] == 3.1
    assert nees(belief, np.array([1, 2, -3.1])).value == pytest.approx((6.2 - 2 * math.pi) ** 2)


def in_ellipse(P, e, p=0.954):
    return bool(
        inside_ellipse(
            Gaussian(np.array([*e, 9.0]), np.pad(np.array(P, float), (0, 1))),
            np.array([0, 0, 1.0]),
            p,
        )
    )


def test_inside_the_ellipse():
    k = radius_factor(0.954)
    for turn in np.linspace(0, 6, 7):
        c, s = math.cos(turn), math.sin(turn)
        e = np.array([0.3 * c, 0.1 * s])
        assert in_ellipse(np.diag([0.09, 0.01]), 0.999 * k * e)
        assert not in_ellipse(np.diag([0.09, 0.01]), 1.001 * k * e)


def test_inside_an_ellipse_without_width():
    line = np.array([[0.5, 0.5], [0.5, 0.5]])
    assert in_ellipse(line, (1.0, 1.0))
    assert not in_ellipse(line, (2.0, 2.0))
    assert not in_ellipse(line, (0.1, -0.1))
    assert in_ellipse(np.zeros((2, 2)), (0, 0))
    assert not in_ellipse(np.zeros((2, 2)), (2e-6, 0))


def in_cone(variance, e, p=0.954):
    return bool(
        inside_cone(
            Gaussian(np.array([9, 9, e]), np.diag([1, 1, variance])), np.array([1.0, 1.0, 0.0]), p
        )
    )


def test_inside_the_cone():
    assert in_cone(0.04, 0.399)
    assert not in_cone(0.04, -0.401)
    assert in_cone(0.04, 2 * math.pi - 0.3)
    assert in_cone(0.04, 0.15, p=0.55)
    assert not in_cone(0.04, 0.16, p=0.55)
    assert in_cone(0.0, 0.9e-6)
    assert not in_cone(0.0, 1.1e-6)


@given(st.floats(0.001, 0.9999), st.integers(1, 2000))
def test_quantiles_are_those_of_scipy(p, dof):
    assert quantile(p, dof) == pytest.approx(chi2.ppf(p, dof), rel=1e-9)
    assert band(p, dof) == pytest.approx(chi2.interval(p, dof), rel=1e-7)


def test_no_freedom_has_no_room():
    assert quantile(0.999, 0) == 0
    assert band(0.99, 0) == (0, 0)


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
