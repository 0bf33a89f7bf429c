"""What every filter must do, whatever its name."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numerics import covariance, definite
from problems import ROOM, begun, classroom, landmark, problem
from scipy.stats import chi2

from ekfsim.diagnostics.verdict import Evidence, Verdict
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian, Particles, Refused
from ekfsim.filters.tuning import CROWDS
from ekfsim.localization import play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.wheels import TwoWheels
from ekfsim.models.sensors.laser import Laser

WEIGHING = ("huber", "pdaf")  # their readings
EXACT = [name for name in FILTERS if name not in (*CROWDS, *WEIGHING, "adaptive")]  # without draws
STAY = ("kf", "kf-nominal")  # linearised where the run begins: the plan of `begun` is to stay there
TOLD = ("predicted", "innovation", "R", "S", "H", "K", "nis", "refused")


def textbook(x, P, model, u, z):
    """Predict and correct, as short as can be."""
    A, B, C = model.A, model.B, model.C
    x, P = A @ x + B @ u, A @ P @ A.T + B @ model.input_noise @ B.T + model.process_noise
    K = P @ C.T @ np.linalg.inv(C @ P @ C.T + model.noise)
    return x + K @ (z - C @ x), (np.eye(len(x)) - K @ C) @ P


@pytest.mark.parametrize(("n", "m", "k"), [(3, 2, 1), (3, 2, 2), (3, 3, 3), (4, 2, 2), (7, 3, 2)])
@pytest.mark.parametrize("name", EXACT)
def test_all_are_the_kalman_filter_where_all_is_linear(name, n, m, k):
    for seed in range(10):
        random = np.random.default_rng(seed)
        model = problem(random, n, m, k)
        x, P = random.normal(size=n), covariance(random, n)
        filter, belief = begun(name, Gaussian(x, P), headings=()), Gaussian(x, P)
        for _ in range(3):
            u, z = random.normal(size=m), random.normal(size=k)
            x, P = textbook(x, P, model, u, z)
            belief, prediction = filter.predict(belief, model, u)
            belief, correction = filter.update(belief, model, z)
            assert belief.mean == pytest.approx(x, rel=1e-8, abs=1e-8)
            assert belief.covariance == pytest.approx(P, rel=1e-8, abs=1e-8)
            np.testing.assert_allclose(prediction.F, model.A, rtol=1e-5, atol=1e-5)
            np.testing.assert_allclose(correction.H, model.C, rtol=1e-5, atol=1e-5)


def test_particles_are_the_kalman_filter_within_their_number():
    """Means to 4 deviations of a sample of that size; covariances to a tenth."""
    random = np.random.default_rng(0)
    model = problem(random, 2, 2, 1)
    model = replace(model, A=0.5 * model.A)
    x, P = np.zeros(2), np.eye(2)
    filter, belief = replace(begun("pf", Gaussian(x, P), headings=()), count=20_000), Gaussian(x, P)
    for _ in range(5):
        u, z = random.normal(size=2), model.C @ x + 0.3 * random.normal(size=1)
        x, P = textbook(x, P, model, u, z)
        belief, _ = filter.predict(belief, model, u)
        belief, correction = filter.update(belief, model, z)
        few = 1 / np.sum(belief.weights**2)
        assert ((belief.mean - x) ** 2 <= 16 * np.diag(P) / few * 4).all()
        assert belief.covariance == pytest.approx(P, rel=0.1, abs=0.05 * np.trace(P))
        np.testing.assert_allclose(correction.H, model.C, atol=1e-6)


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("gate", [None, 0.9])
@pytest.mark.parametrize("kind", ["laser", "landmark"])
def test_a_batch_equals_its_runs(name, gate, kind):
    random = np.random.default_rng(7)
    runs = (0, 3, 1500, 2, 9)
    first, laser, motion = classroom(random, (5,))
    first.covariance[1] = 0
    first.covariance[2, 2] = first.covariance[2, :, 2] = 0
    first.mean[0, :2] = (-5, 4)  # outside: some beams meet nothing
    sensor = laser if kind == "laser" else landmark()
    batch_filter, batch = begun(name, first, gate, runs=runs), first
    alone = [
        (
            begun(name, Gaussian(first.mean[i], first.covariance[i]), gate, runs=(run,)),
            Gaussian(first.mean[i], first.covariance[i]),
        )
        for i, run in enumerate(runs)
    ]
    for turn in range(4):
        u = random.uniform(-0.5, 0.5, (5, 2))
        z = sensor.h(batch.mean) * random.uniform(0.9, 1.1, (5, 1))
        z[turn] = np.nan
        skip = random.random(5) < 0.2
        batch, prediction = batch_filter.predict(batch, motion, u)
        batch, correction = batch_filter.update(batch, sensor, z, skip)
        for i, (filter, belief) in enumerate(alone):
            belief, one_prediction = filter.predict(belief, motion, u[i])
            belief, one = filter.update(belief, sensor, z[i], skip[i])
            alone[i] = (filter, belief)
            same(prediction.F[i], one_prediction.F)
            same(prediction.G[i], one_prediction.G)
            for attribute in TOLD:
                same(getattr(correction, attribute)[i], np.asarray(getattr(one, attribute)))
            for attribute in (
                "mean",
                "covariance",
                *(("states", "weights") if name == "pf" else ()),
            ):
                same(getattr(batch, attribute)[i], getattr(belief, attribute))


def same(a, b):
    assert a.shape == b.shape
    assert a == pytest.approx(b, rel=1e-12, abs=1e-12, nan_ok=True)


@pytest.mark.parametrize("axes", [(1,), (2, 3)])
@pytest.mark.parametrize("name", FILTERS)
def test_any_leading_axes(name, axes):
    random = np.random.default_rng(1)
    first, laser, motion = classroom(random, axes)
    filter = begun(name, first, runs=range(math.prod(axes)))
    belief, prediction = filter.predict(first, motion, np.full((*axes, 2), 0.1))
    belief, correction = filter.update(belief, laser, laser.h(first.mean))
    assert belief.mean.shape == (*axes, 3)
    assert belief.covariance.shape == prediction.F.shape == (*axes, 3, 3)
    assert correction.nis.shape == correction.refused.shape == axes
    assert correction.K.shape == (*axes, 3, 1)


@pytest.mark.parametrize("name", FILTERS)
def test_a_covariance_stays_one_over_thousands_of_steps(name):
    """200 robots take 1 000 steps each among landmarks, each seen from near and far; of particles
    there are fewer."""
    robots = 20 if name in CROWDS else 200
    steps = 1000 if name not in CROWDS else 100
    random = np.random.default_rng(2)
    motion = TwoWheels(0.5, 0.002)
    first = Gaussian(np.zeros((robots, 3)), np.zeros((robots, 3, 3)))
    truth = np.zeros((robots, 3))
    filter, belief = begun(name, first, 0.999, runs=range(robots)), first
    for step in range(steps):
        way = np.array([0.02, 0.021]) + 0.002 * random.normal(size=(robots, 2))
        truth = motion.f(truth, np.broadcast_to([0.02, 0.021], (robots, 2)))
        belief, _ = filter.predict(belief, motion, way)
        if step % 2:
            sensor = landmark(random.uniform(-4, 4), random.uniform(-1, 7), 0.05, 0.01)
            z = sensor.h(truth) + random.normal(size=(robots, 2)) * (0.05, 0.01)
            belief, correction = filter.update(belief, sensor, z)
            assert np.array_equal(correction.S, correction.S.mT) or name in (
                *STAY,
                *WEIGHING,
                "ekf",
                "iekf",
            )
        if step % 5 == 0:
            assert definite(belief.covariance, 1e-12)
            assert (np.abs(belief.mean[:, 2]) <= math.pi).all()
            assert np.isfinite(belief.mean).all()
    if name not in STAY:  # they are linearised where the robot no longer is
        assert np.median(np.hypot(*(belief.mean - truth)[:, :2].T)) < 0.05


def in_room(
    name,
    z,
    x=(3.0, 4.0, 0.1),
    P=np.diag([0.01, 0.02, 0.003]),  # noqa: B008
    ratio=0.01,
    gate=None,
    skip=False,
    walls=ROOM,
):
    prior, laser = Gaussian(np.array(x, float), np.array(P, float)), Laser(walls, 0.0, ratio)
    return prior, *begun(name, prior, gate).update(prior, laser, np.array([z], float), skip)


def untouched(prior, posterior):
    return (posterior.mean == prior.mean).all() and (posterior.covariance == prior.covariance).all()


@pytest.mark.parametrize("name", FILTERS)
def test_what_is_refused_changes_nothing(name):
    prior, posterior, correction = in_room(name, np.nan)
    assert untouched(prior, posterior)
    assert correction.refused == Refused.NO_ECHO
    assert np.isnan(correction.nis)
    prior, posterior, correction = in_room(name, 7.3, skip=True)
    assert untouched(prior, posterior)
    assert correction.refused == Refused.GUARD
    assert correction.nis > 0
    assert np.abs(correction.K).max() > 0  # what it would have done is told all the same
    used = in_room(name, 7.3)
    assert used[2].refused == Refused.NOT
    assert not untouched(*used[:2])
    assert correction.nis == used[2].nis


@pytest.mark.parametrize("name", FILTERS)
def test_nothing_in_view(name):
    prior, posterior, correction = in_room(name, 5.0, x=(-3.0, 4.0, 3.0))
    assert untouched(prior, posterior)
    assert correction.refused == Refused.NO_WALL
    assert np.isnan(correction.nis)
    assert np.isnan(correction.S).all()
    assert (correction.K == 0).all()
    # the first reason that holds
    assert in_room(name, np.nan, x=(-3.0, 4.0, 3.0))[2].refused == Refused.NO_ECHO


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("k", [1, 2])
def test_the_gate_refuses_what_lies_beyond_its_quantile(name, k):
    random = np.random.default_rng(8)
    model = problem(random, k=k)
    prior = Gaussian(random.normal(size=3), covariance(random, 3) + 0.1 * np.eye(3))
    _, correction = begun(name, prior, headings=()).update(prior, model, np.zeros(k))
    along = np.linalg.cholesky(correction.S) @ np.eye(k)[0]
    for share, refused in ((0.999, Refused.NOT), (1.001, Refused.GATE)):
        z = correction.predicted + along * math.sqrt(share * chi2.ppf(0.99, k))
        posterior, judged = begun(name, prior, 0.99, headings=()).update(prior, model, z)
        assert judged.refused == refused
        assert judged.nis == pytest.approx(share * chi2.ppf(0.99, k))
        assert untouched(prior, posterior) == (refused != Refused.NOT)


@pytest.mark.parametrize("name", FILTERS)
def test_a_certain_belief_stays_so(name):
    """P₀ = 0: nothing is learnt from a reading, and a motion without noise adds no doubt."""
    first = Gaussian(np.array([3.0, 4.0, 0.1]), np.zeros((3, 3)))
    prior, posterior, correction = in_room(name, 7.2, P=np.zeros((3, 3)))
    assert posterior.mean == pytest.approx(prior.mean, abs=1e-15)
    assert (posterior.covariance == 0).all()
    assert correction.nis == pytest.approx(
        (7.2 - 7 / math.cos(0.1)) ** 2 / (0.07 / math.cos(0.1)) ** 2
    )
    *_, correction = in_room(name, 7.2, P=np.zeros((3, 3)), ratio=0.0, gate=0.5)
    assert correction.refused == Refused.NOT
    assert np.isnan(correction.nis)
    assert (correction.K == 0).all()
    belief, _ = begun(name, first).predict(first, MoveTurn(0.0, 0.0), np.array([1.0, 0.3]))
    assert (belief.covariance == 0).all()
    belief, prediction = begun(name, first).predict(first, MoveTurn(0.1, 0.1), np.array([1.0, 0.3]))
    assert belief.covariance == pytest.approx(
        prediction.G @ np.diag([0.01, 0.0009]) @ prediction.G.T,
        abs=0.002 if name in CROWDS else 1e-15,
    )


@pytest.mark.parametrize("rank", [1, 2])
@pytest.mark.parametrize("name", FILTERS)
def test_a_singular_covariance(name, rank):
    """A sensor that sees what is certain learns nothing; what depends on what it sees moves
    along."""
    for seed in range(10):
        random = np.random.default_rng(seed)
        P = 1e-3 * covariance(random, 3, rank=rank)
        prior, posterior, correction = in_room(name, 7.1, P=P)
        assert definite(posterior.covariance, 1e-9)
        moved = posterior.mean - prior.mean
        if name == "invariant":  # which goes on from that along an arc
            moved = correction.K @ correction.innovation
        V = np.linalg.eigh(P)[1][:, : 3 - rank]
        # a circular mean is no sum
        assert V.T @ moved == pytest.approx(0, abs=2e-5 if name in CROWDS else 1e-9)
        assert np.isfinite(correction.K).all()
        if name != "iekf":  # whose S is that of the prediction, and H is not
            np.testing.assert_allclose(
                correction.H @ P, correction.K.T * correction.S, rtol=1e-6, atol=1e-6
            )


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("heading", [math.pi - 0.01, -math.pi + 0.01])
def test_a_heading_at_the_turn_of_the_circle(name, heading):
    """The same problem turned round: robot, landmark and all."""
    results = []
    for θ in (0.0, heading):
        c, s = math.cos(θ), math.sin(θ)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        first = Gaussian(np.array([0.0, 0.0, θ]), turn @ np.diag([0.04, 0.01, 0.04]) @ turn.T)
        mark = turn[:2, :2] @ (-3.0, 0.1)  # behind: its bearing, too, is at the turn of the circle
        filter = begun(name, first)
        belief, _ = filter.predict(first, MoveTurn(0.05, 0.1), np.array([0.5, 0.1]))
        belief, correction = filter.update(belief, landmark(*mark), np.array([3.52, -3.12]))
        gone = turn.T @ (belief.mean - (0, 0, θ))
        gone[2] = math.remainder(belief.mean[2] - θ, 2 * math.pi)
        results.append((gone, turn.T @ belief.covariance @ turn, correction))
        assert -math.pi < belief.mean[2] <= math.pi
        assert abs(correction.innovation[1]) < 0.3
    # the root of P turns, and the particles' draws with it
    tolerance = 0.1 if name in CROWDS else 1e-9
    if name not in STAY:
        assert results[0][0] == pytest.approx(
            results[1][0], abs=tolerance if not name.startswith("ukf") else 2e-3
        )
        assert results[0][1] == pytest.approx(
            results[1][1], abs=tolerance if not name.startswith("ukf") else 2e-3
        )


@pytest.mark.parametrize("name", FILTERS)
def test_nothing_handed_in_is_changed(name):
    first, laser, motion = classroom(np.random.default_rng(3))
    first.mean[2] = 3.1
    filter = begun(name, first)
    belief, _ = filter.predict(first, motion, np.array([0.1, 0.1]))
    u, z, inside = (
        np.array([0.3, 0.2]),
        laser.h(first.mean) + 0.01,
        [belief.mean, belief.covariance],
    )
    arrays = [first.mean, first.covariance, u, z, *inside]
    arrays += [belief.states, belief.weights] if isinstance(belief, Particles) else []
    copies = [array.copy() for array in arrays]
    for array in arrays:
        array.flags.writeable = False
    for given in (first, belief):
        filter.predict(given, motion, u)
        filter.update(given, laser, z)
    assert all(np.array_equal(array, copy) for array, copy in zip(arrays, copies, strict=True))


@pytest.mark.parametrize("name", FILTERS)
def test_a_tour_of_a_room_ends_consistent(name):
    """24 runs of the classroom: no more are lost at the end than chance allows."""
    runs = 24
    random = np.random.default_rng(4)
    truth = np.tile([2.0, 2.0, 0.0], (runs, 1)) + random.normal(size=(runs, 3)) * (0.1, 0.1, 0.05)
    first = Gaussian(
        np.tile([2.0, 2.0, 0.0], (runs, 1)), np.tile(np.diag([0.01, 0.01, 0.0025]), (runs, 1, 1))
    )
    motion, quiet = MoveTurn(0.03, 0.03), MoveTurn(0.0, 0.0)
    filter, belief = begun(name, first, runs=range(runs)), first
    for _ in range(2):
        for d, a in ((3.0, 90), (3.0, 0), (1.0, 90), (3.0, 90), (4.0, 90)):
            u = np.broadcast_to([d, math.radians(a)], (runs, 2))
            truth = quiet.f(truth, u)
            belief, _ = filter.predict(
                belief, motion, u * (1 + 0.03 * random.normal(size=(runs, 2)))
            )
            for bearing in (0.1, 1.6, -1.5):
                laser = Laser(ROOM, bearing, 0.02)
                z = laser.h(truth) * (1 + 0.02 * random.normal(size=(runs, 1)))
                belief, _ = filter.update(belief, laser, z)
    e = belief.mean - truth
    e[:, 2] = np.arctan2(np.sin(e[:, 2]), np.cos(e[:, 2]))
    nees = np.vecdot(e, np.linalg.solve(belief.covariance, e[..., None])[..., 0])
    lost = np.count_nonzero(nees > chi2.ppf(0.999, 3))
    assert lost == runs if name in STAY else lost <= 1  # they are linearised for the first heading


@pytest.mark.parametrize("name", FILTERS)
def test_the_packaged_tour_ends_consistent(name):
    """kf, which is linearised for the first heading, is lost after the first turn, and says why it
    may be."""
    evidence = Evidence()
    for step in play(replace(load_scene("tour"), filter=name)):
        evidence.add(step)
    assert evidence.verdict == (Verdict.LOST if name == "kf" else Verdict.CONSISTENT)
    assert (FILTERS[name].remark != "") == (name in STAY)
