"""The smoother against one Gaussian of the start and all noises, conditioned on all readings at
once: a matrix and a solve, that share no recursion with it."""

from dataclasses import replace

import numpy as np
import pytest
from numerics import covariance
from problems import Linear, begun, problem

import ekfsim
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import localize, play
from ekfsim.models.layout import Layout
from ekfsim.records import Control, Entry, Reading
from ekfsim.smoothing import rts, smooth

KALMAN = ("kf", "ekf", "iekf", "ukf", "ukf-augmented")


def layout(n, headings=()):
    places = tuple(range(n)) if n >= 3 else (0, 0, 0)
    return Layout(tuple(f"x{i}" for i in range(n)), places[:2], places[2], headings)


def all_at_once(first, models, entries):
    """Mean and covariance of the state at every entry, with all that was read in the run.

    With s = (x₀, w₁ … w_t) each state is c + T s and each reading C x + v."""
    n, t = len(first.mean), sum(isinstance(entry.given, Control) for entry in entries)
    Σ = np.zeros(((t + 1) * n,) * 2)
    Σ[:n, :n] = first.covariance
    c, T, moved = first.mean, np.eye(n, (t + 1) * n), 0
    at, H, R, ν = [], [], [], []
    for entry, model in zip(entries, models, strict=True):
        if isinstance(entry.given, Control):
            moved += 1
            here = slice(moved * n, (moved + 1) * n)
            Σ[here, here] = model.B @ model.input_noise @ model.B.T + model.process_noise
            c, T = model.A @ c + model.B @ entry.given.u, model.A @ T
            T[:, here] = np.eye(n)
        elif isinstance(entry.given, Reading) and not np.isnan(entry.given.z).any():
            H.append(model.C @ T)
            R.append(model.noise)
            ν.append(entry.given.z - model.C @ c)
        at.append((c, T))
    if not H:
        return [Gaussian(c, T @ Σ @ T.T) for c, T in at]
    rows, noise = np.concatenate(H), np.zeros((sum(map(len, R)),) * 2)
    k = 0
    for one in R:
        noise[k : k + len(one), k : k + len(one)] = one
        k += len(one)
    K = np.linalg.solve(rows @ Σ @ rows.T + noise, rows @ Σ).T
    s, left = K @ np.concatenate(ν), Σ - K @ rows @ Σ
    return [Gaussian(c + T @ s, T @ left @ T.T) for c, T in at]


def log(model, random, doing):
    """The start and an entry for each letter: m a motion, z a reading, n none of it, k nothing."""
    entries = [Entry(0, None)]
    for index, letter in enumerate(doing, start=1):
        given = None
        if letter == "m":
            given = Control(model, random.normal(size=model.B.shape[-1]))
        elif letter in "zn":
            z = 3 * random.normal(size=len(model.C))
            given = Reading(model, z if letter == "z" else np.full_like(z, np.nan))
        entries.append(Entry(index, given))
    return entries


def played(name, first, entries, headings=()):
    n = len(first.mean)
    return list(localize(entries, begun(name, first, headings=headings), first,
                         layout=layout(n, headings)))  # fmt: skip


def agree(steps, wanted, atol=1e-9):
    for step, (mean, P) in zip(steps, wanted, strict=True):
        np.testing.assert_allclose(step.posterior.mean, mean, atol=atol, rtol=0)
        np.testing.assert_allclose(step.posterior.covariance, P, atol=atol, rtol=0)


@pytest.mark.parametrize("name", KALMAN)
@pytest.mark.parametrize(("n", "m", "k"), [(1, 1, 1), (3, 2, 1), (4, 2, 2)])
@pytest.mark.parametrize("doing", ["mz" * 6, "zmmzzmnmkmzzm", "m", "z", "", "mmm"])
def test_it_is_the_gaussian_of_all_readings_at_once(name, n, m, k, doing):
    random = np.random.default_rng(n)
    model = problem(random, n, m, k)
    model.A = np.linalg.qr(model.A)[0]
    first = Gaussian(random.normal(size=n), covariance(random, n))
    entries = log(model, random, doing)
    agree(smooth(played(name, first, entries)), all_at_once(first, [model] * len(entries), entries))


@pytest.mark.parametrize("name", KALMAN)
def test_a_certain_start_stays_and_noise_of_fewer_directions_than_states_is_no_matter(name):
    random = np.random.default_rng(5)
    model = replace(problem(random, 4, 2, 1), process_noise=0.0 * np.eye(4))
    model.A = np.linalg.qr(model.A)[0]
    first = Gaussian(random.normal(size=4), np.zeros((4, 4)))
    entries = log(model, random, "mzmzzmmz")
    smoothed = smooth(played(name, first, entries))
    agree(smoothed, all_at_once(first, [model] * len(entries), entries))
    np.testing.assert_array_equal(smoothed[0].posterior.mean, first.mean)
    assert not smoothed[0].posterior.covariance.any()


def walk(variance=1.0, noise=1.0):
    one = np.ones((1, 1))
    return Linear(one, 0 * one, 0 * one, variance * one, one, noise * one)


def test_a_random_walk_with_a_reading_missing():
    model = walk()
    entries = [Entry(0, None)]
    for z in (1.0, np.nan, 2.0):
        entries.append(Entry(len(entries), Control(model, np.zeros(1))))
        entries.append(Entry(len(entries), Reading(model, np.array([z]))))
    steps = smooth(played("ekf", Gaussian(np.zeros(1), np.eye(1)), entries))
    at = [steps[i].posterior for i in (0, 2, 4, 6)]
    assert [round(float(x[0]), 4) for x, _ in at] == [0.4545, 0.9091, 1.2727, 1.6364]
    assert [round(float(P[0, 0]), 4) for _, P in at] == [0.6364, 0.5455, 0.9091, 0.7273]


def test_steps_of_unequal_length_are_each_passed_by_their_own():
    """Steps of 1, 0.1, 5, 1, 2 s; smoothed 1.389 to 2.02 at first where a list is shifted."""
    entries, models = [Entry(0, None)], [None]
    for dt, z in ((1, 1.0), (0.1, 1.2), (5, 2.0), (1, 3.0), (2, 2.0)):
        A = np.array([[1, dt], [0, 1.0]])
        Q = 0.5 * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
        model = Linear(A, np.zeros((2, 1)), np.eye(1), Q, np.eye(1, 2), 0.5 * np.eye(1))
        for given in (Control(model, np.zeros(1)), Reading(model, np.array([z]))):
            entries.append(Entry(len(entries), given))
            models.append(model)
    first = Gaussian(np.zeros(2), 2 * np.eye(2))
    steps = played("ekf", first, entries)
    wanted = all_at_once(first, models, entries)
    agree(smooth(steps), wanted)
    told = [[round(float(s.posterior.mean[0]), 3) for s in some[2::2]]
            for some in (steps, smooth(steps))]  # fmt: skip
    assert told == [[0.893, 1.072, 2.018, 2.805, 2.164], [0.997, 1.036, 2.348, 2.504, 2.164]]


def test_readings_of_one_instant_in_any_order():
    model, first = walk(), Gaussian(np.zeros(1), np.eye(1))
    move, read = Control(model, np.zeros(1)), lambda z: Reading(model, np.array([z]))
    one = [None, move, read(1.0), read(2.0), move, read(-1.0)]
    other = [None, move, read(2.0), read(1.0), move, read(-1.0)]
    first_of, last_of = (
        smooth(played("ekf", first, [Entry(i, given) for i, given in enumerate(some)]))
        for some in (one, other)
    )
    agree(first_of, [step.posterior for step in last_of], atol=1e-14)


def test_a_heading_across_the_seam():
    """What is smoothed turns along with the world: nothing is special about 180°."""
    one = np.eye(1)
    model = Linear(one, one, 0.01 * one, 0 * one, one, 0.04 * one, angles=(0,))
    turned = []
    for zero in (0.0, np.pi - 0.05):
        given = [None, Control(model, np.array([0.03])), Reading(model, np.array([zero + 0.1]))]
        given += [Control(model, np.array([0.03])), Reading(model, np.array([zero + 0.2]))]
        first = Gaussian(np.array([zero]), 0.1 * one)
        entries = [Entry(i, each) for i, each in enumerate(given)]
        steps = smooth(played("ekf", first, entries, (0,)))
        turned.append(np.array([step.posterior.mean[0] - zero for step in steps]))
        assert all(-np.pi < step.posterior.mean[0] <= np.pi for step in steps)
    np.testing.assert_allclose(np.angle(np.exp(1j * turned[1])), turned[0], atol=1e-12)


@pytest.mark.parametrize("name", ["ekf", "ukf", "pf"])
def test_many_runs_are_each_as_alone_and_portions_change_nothing(name, monkeypatch):
    scene = ekfsim.load_scene("tour").with_("filter.particles", 50, filter=name) if name == "pf" \
        else ekfsim.load_scene("tour").with_(filter=name)  # fmt: skip
    many = smooth(play(scene, np.arange(3)))
    monkeypatch.setattr(rts, "TOGETHER", 7)
    alone = smooth(play(scene.with_(run=2)))
    for step, one in zip(many, alone, strict=True):
        np.testing.assert_allclose(step.posterior.mean[2], one.posterior.mean, atol=1e-9)
        np.testing.assert_allclose(
            step.posterior.covariance[2], one.posterior.covariance, atol=1e-9
        )


def test_a_crowd_passes_on_what_its_own_moments_say():
    """Of a linear motion the regression of many particles is near the slope, and not the slope."""
    random = np.random.default_rng(3)
    model = problem(random, 3, 2, 1)
    model.A = np.linalg.qr(model.A)[0]
    first = Gaussian(np.zeros(3), np.eye(3))
    steps = played("pf", first, log(model, random, "mmm"))
    from ekfsim.smoothing.passing import slope

    F = slope(steps[2])
    assert 0 < np.abs(F - model.A).max() < 0.4
    before, after = steps[2].prior, steps[2].posterior
    δ, δ_after = before.states - before.mean, after.states - after.mean
    np.testing.assert_allclose(
        before.covariance @ F.T, (before.weights[:, None] * δ).T @ δ_after, atol=1e-9
    )


def test_sigma_points_tell_the_covariance_of_before_and_after():
    """P Fᵀ is P_xy of the points themselves, about a motion that bends."""
    from ekfsim.filters.arithmetic.square_root import square_root
    from ekfsim.filters.arithmetic.unscented import sigma_points, weights
    from ekfsim.models.motions.move_turn import MoveTurn

    motion, u = MoveTurn(0.05, 0.05), np.array([2.0, 0.6])
    x, P = np.array([1.0, 2.0, 0.5]), covariance(np.random.default_rng(2), 3) * 0.05
    for name in ("ukf",):
        W = weights(3)
        _, made = begun(name, Gaussian(x, P)).predict(Gaussian(x, P), motion, u)
        X = sigma_points(x, square_root(P), W.spread)
        Y = motion.f(X, u)
        cross = (W.covariance[:, None] * (X - x)).T @ (Y - W.mean @ Y)
        np.testing.assert_allclose(P @ made.F.T, cross, atol=1e-9)
        assert np.abs(made.F - motion.F(x, u)).max() > 1e-3


def test_where_the_filter_is_honest_so_is_the_smoother_and_it_errs_less():
    scene = ekfsim.load_scene("square")
    steps = list(play(scene, np.arange(400)))
    smoothed = smooth(steps)
    beyond, far, near = [], 0.0, 0.0
    from ekfsim.filters.arithmetic.chi_square import quantile

    for filtered, step in zip(steps[1:], smoothed[1:], strict=True):
        assert step.nees.dof.min() > 0
        limits = np.array([0.0, *(quantile(0.5, n) for n in (1, 2, 3))])[step.nees.dof]
        beyond.append(step.nees.value > limits)
        far += np.sum((filtered.posterior.mean - step.entry.truth)[:, :2] ** 2)
        near += np.sum((step.posterior.mean - step.entry.truth)[:, :2] ** 2)
    assert 0.45 < np.mean(beyond) < 0.55
    assert near < 0.6 * far


def test_the_last_belief_is_the_filters_and_nothing_comes_of_nothing():
    steps = list(play(ekfsim.load_scene("tour")))
    last = smooth(steps)[-1]
    np.testing.assert_array_equal(last.posterior.mean, steps[-1].posterior.mean)
    assert float(last.nees.value) == pytest.approx(float(steps[-1].nees.value))
    assert smooth([]) == []
