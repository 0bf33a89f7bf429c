import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numerics import covariance

from ekfsim.diagnostics.nees import error, nees, squared_mahalanobis
from ekfsim.filters.belief import Gaussian

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
        assert squared_mahalanobis(np.array([0.1, 0.1]), P)[1] == rank
        assert squared_mahalanobis(np.array([[0.1, 0.1]]), P[None])[1] == rank


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
    one, batch = squared_mahalanobis(e, P), squared_mahalanobis(e[None], P[None])
    assert float(one[0]) == pytest.approx(float(batch[0][0]), rel=1e-4 if power < -4 else 1e-9)
    assert (int(one[1]), bool(one[2])) == (int(batch[1][0]), bool(batch[2][0]))


def test_errors_of_headings_go_the_short_way_round():
    belief = Gaussian(np.array([1.0, 2.0, 3.1]), np.eye(3))
    assert error(belief, np.array([0.5, 2.5, -3.1])) == pytest.approx(
        [0.5, -0.5, 6.2 - 2 * math.pi]
    )
    assert belief.mean[2] == 3.1
    assert nees(belief, np.array([1, 2, -3.1])).value == pytest.approx((6.2 - 2 * math.pi) ** 2)
