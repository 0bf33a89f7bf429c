"""Whiteness of innovations, held against what NumPy and SciPy make of the same numbers, and against
its own promise: of 1000 right runs it condemns 50.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import beta, binom, chi2, kstest

from ekfsim import load_scene
from ekfsim.diagnostics.innovations import LEVEL, Innovations, named, whitened
from ekfsim.diagnostics.whiteness import whiteness
from ekfsim.filters.belief import Correction
from ekfsim.localization import play
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.position import Position
from ekfsim.records import Entry, Reading, Step

RIGHT = 1000
# of 1000 right runs 50 are to be condemned; a right test leaves this with a chance of 1 in 1000
FEWEST, MOST = binom.ppf([0.0005, 0.9995], RIGHT, LEVEL) / RIGHT


def white(n, k=1, runs=RIGHT, seed=1):
    return np.random.default_rng(seed).normal(size=(runs, n, k))


def found_in(scene, runs=None):
    gathered = Innovations()
    for step in play(scene, runs):
        gathered.add(step)
    return gathered.found()


def read(w, refused=0, nis=None, S=None):
    """A step that read these whitened numbers. w : (k,)"""
    k = len(w)
    S = np.eye(k) if S is None else S
    nis = np.asarray(float(w @ w) if nis is None else nis)
    nothing = np.zeros(())
    correction = Correction(w, w, S, S, nothing, nothing, nis, np.asarray(refused))
    reading = Reading(Position(1.0, 1.0), w, "gnss")
    return Step(Entry(1, reading), None, None, correction=correction)


def test_lags_are_around_zero_and_the_mean_stays():
    w = white(40, runs=1, seed=3)[0] + 3.0
    one = whiteness("gnss", ("x",), ["gnss"] * 40, w)
    v = w[:, 0]
    for j in range(1, 6):
        assert one.lags[j - 1] == pytest.approx(v[j:] @ v[:-j] / (v @ v))
    z = one.lags * np.sqrt(40 * 42 / np.arange(39, 34, -1))
    assert one.p_lags == pytest.approx(chi2.sf(z @ z, 5))
    assert one.means[0, 0] == pytest.approx(v.mean())
    share = 40 * v.mean() ** 2 / (v @ v)
    assert one.p_mean == pytest.approx(beta.sf(share, 0.5, 39 / 2), rel=1e-6)
    assert one.p_lags < 1e-9
    assert one.p_mean < 1e-9


@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize(("n", "targets"), [(11, 1), (15, 4), (64, 4), (300, 1)])
def test_each_test_keeps_its_promise(n, targets, k):
    names = [f"node {i % targets}" for i in range(n)]
    one = whiteness("node", ("x", "y")[:k], names, white(n, k, seed=n + k))
    for p in (one.p_lags, one.p_target_lags, one.p_mean):
        if not np.isnan(p).all():
            assert FEWEST <= np.mean(p < LEVEL) <= MOST
    assert kstest(one.p_mean, "uniform").pvalue > 0.001


@pytest.mark.parametrize(("commands", "least", "most"), [
    ("diverge-00-control", 0.0, 0.06),
    ("diverge-03a-wheel-scale", 0.8, 1.0),
    ("diverge-03b-turn-scale", 0.8, 1.0),
    ("diverge-04a-range-bias-all-round", 0.99, 1.0),
])  # fmt: skip
def test_what_it_condemns(commands, least, most):
    found = found_in(load_scene(commands), np.arange(RIGHT))
    assert least <= np.mean(found.coloured) <= most


def test_lags_of_a_known_run():
    """The numbers were computed from the trace, with other code."""
    biased = found_in(load_scene("diverge-04a-range-bias-all-round"))
    assert biased.sensors[0].lags[:3].round(2).tolist() == [0.67, 0.56, 0.65]
    assert biased.word == "not white"
    control = found_in(load_scene("diverge-00-control"))
    assert control.word == "white"


def test_a_batch_is_its_runs():
    scene = load_scene("tour")
    side_by_side = found_in(scene, np.arange(3))
    for run in range(3):
        alone = found_in(replace(scene, run=run))
        assert float(side_by_side.p[run]) == pytest.approx(float(alone.p), rel=1e-9)
        np.testing.assert_allclose(side_by_side.sensors[0].lags[run], alone.sensors[0].lags)


def test_what_is_left_out_is_counted_and_closes_up():
    w = white(30, 2, runs=1, seed=5)[0]
    whole, gaps = Innovations(), Innovations()
    for i, one in enumerate(w):
        whole.add(read(one))
        gaps.add(read(one))
        if i % 3 == 0:
            gaps.add(read(np.full(2, 9.0), refused=4))  # by the gate
            gaps.add(read(np.full(2, np.nan), refused=1, nis=np.nan))  # no echo
            gaps.add(read(np.zeros(2), nis=np.nan, S=np.zeros((2, 2))))
    a, b = whole.found(), gaps.found()
    assert (int(b.no_reading), int(b.refused), int(b.certain)) == (10, 10, 10)
    assert float(a.p) == float(b.p)
    assert int(b.sensors[0].readings) == 30


def test_few_readings_are_no_evidence():
    gathered = Innovations()
    assert gathered.found().word == "no evidence"
    for one in white(9, 2, runs=1)[0] + 50.0:
        gathered.add(read(one))
    found = gathered.found()
    assert found.word == "no evidence"
    assert math.isnan(found.p)
    assert found.table()["p"] is None
    gathered.add(read(np.array([50.0, 50.0])))
    assert gathered.found().word == "not white"


def test_a_size_alone_is_no_lack_of_whiteness():
    w = white(100, 1, seed=8)
    one, large = (whiteness("l", ("r",), ["l"] * 100, w * size) for size in (1.0, 7.0))
    np.testing.assert_allclose(one.tests, large.tests)


def test_whitened_numbers_have_the_unit_covariance():
    random = np.random.default_rng(2)
    S = np.array([[4.0, 0.003], [0.003, 9e-6]])  # m and rad
    w = whitened(random.multivariate_normal([0, 0], S, 20_000), np.broadcast_to(S, (20_000, 2, 2)))
    np.testing.assert_allclose(np.cov(w.T), np.eye(2), atol=0.04)
    assert np.isnan(whitened(np.ones(2), np.zeros((2, 2)))).all()
    assert np.isnan(whitened(np.ones(2), np.ones((2, 2)))).all()  # of rank 1
    np.testing.assert_allclose(whitened(np.ones(1), np.array([[4.0]])), [0.5])


def test_changes_of_sign_are_tosses_of_a_coin():
    v = white(60, runs=1, seed=4)[0]
    one = whiteness("l", ("r",), ["l"] * 60, v)
    changes = int(np.count_nonzero(np.diff(np.sign(v[:, 0]))))
    assert int(one.changes) == changes
    two_sided = min(1.0, 2 * min(binom.cdf(changes, 59, 0.5), binom.sf(changes - 1, 59, 0.5)))
    assert one.p_runs == pytest.approx(two_sided)
    assert whiteness("l", ("r",), ["l"] * 60, abs(v)).p_runs < 1e-15


def test_sensors_and_targets_by_name():
    position = Position(1.0, 1.0)
    assert named(Reading(position, None, "node 3")) == ("node", "node 3")
    assert named(Reading(Frozen(position, None), None, "gnss")) == ("gnss", "gnss")
    scene = load_scene("tour")
    sides = {
        round(math.degrees(step.entry.given.sensor.bearing)): named(step.entry.given)[1]
        for step in play(scene)
        if step.correction is not None
    }
    assert {sides[bearing] for bearing in sides if abs(bearing) < 45} <= {"ahead"}
    assert all(sides[b] == "left" for b in sides if 45 < b < 135)
