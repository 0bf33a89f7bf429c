"""The fast forms of prediction, update and NEES are those of the readable text: to 1e-12, run by
run."""

import dataclasses

import numpy as np
import pytest
from backends import BACKENDS
from numerics import covariance, definite
from problems import ROOM, classroom
from scenes import rich, unbounded

from ekfsim.diagnostics.nees import nees, squared_mahalanobis
from ekfsim.filters import unrolled
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.correcting import Linearized, corrected
from ekfsim.filters.ekf import EKF
from ekfsim.geometry.soa import lanes
from ekfsim.localization import play
from ekfsim.models.motions.wheels import GyroWheels
from ekfsim.models.sensors.landmarks import BearingOnly, RangeOnly
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.twins import taking

RUNS = 200
NEAR = {"rtol": 1e-12, "atol": 1e-12}
backends = pytest.mark.parametrize("name", BACKENDS)


@pytest.fixture
def random():
    return np.random.default_rng(11)


@backends
@pytest.mark.parametrize("process", [0.0, np.diag([1.0, 2.0, 3.0]) * 1e-3])
def test_a_prediction_is_that_of_the_matrices(name, process, random):
    (x, P), _, motion = classroom(random, (RUNS,))
    u = random.uniform(-1, 1, (RUNS, 2))
    for F, G, M in (motion.linearize(x, u)[1:4], (motion.F(x, u), motion.G(x, u), motion.M(u))):
        with taking(name):
            new = unrolled.predicted(P, F, G, M, process)
        np.testing.assert_allclose(new, F @ P @ F.mT + G @ M @ G.mT + process, **NEAR)
        np.testing.assert_array_equal(new, new.mT)


@backends
def test_wheels_with_a_gyro_and_a_clock_are_predicted_so_too(name, random):
    (x, P), _, _ = classroom(random, (RUNS,))
    motion = GyroWheels(0.5, 0.01, np.diag([1e-6, 1e-6, 1e-7]))
    u = np.concatenate([random.uniform(-1, 1, (RUNS, 3)), np.full((RUNS, 1), 0.1)], axis=-1)
    _, F, G, M, Q = motion.linearize(x, u)
    M = np.broadcast_to(M, (RUNS, *M.shape[-2:]))
    with taking(name):
        new = unrolled.predicted(P, F, G, M, Q)
    np.testing.assert_allclose(new, F @ P @ F.mT + G @ M @ G.mT + Q, **NEAR)


@backends
def test_what_it_does_not_know_is_left_to_the_matrices(name, random):
    (x, P), _, motion = classroom(random, (RUNS,))
    _, F, G, M, Q = motion.linearize(x, random.uniform(-1, 1, (RUNS, 2)))
    with taking(name):
        for i, j in np.ndindex(3, 3):
            if (i, j) not in ((0, 2), (1, 2)):
                other = F.copy()
                other[-1, i, j] += 1e-9
                assert unrolled.predicted(P, other, G, M, Q) is None
        for i, j in ((0, 1), (1, 0)):
            other = M.copy()
            other[-1, i, j] = 1e-9
            assert unrolled.predicted(P, F, G, other, Q) is None
    assert unrolled.predicted(P[:9], F[:9], G[:9], M[:9], Q) is None


def sensors():
    return (
        Laser(ROOM, 0.4, 0.02),
        Laser(ROOM, 0.4, 1e-7),
        RangeOnly(2.0, 3.0, 0.1),
        BearingOnly(2.0, 3.0, 0.02),
    )


@backends
@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("gate", [None, 0.5])
def test_an_update_is_that_of_the_matrices(name, number, gate, random):
    """Readings that are nan, certain beliefs and skipped runs among the others, and a laser sharper
    than any belief."""
    (x, P), sensor = classroom(random, (RUNS,))[0], sensors()[number]
    x[::17] += [20.0, 0.0, 0.0]  # beyond the room: some beams meet nothing
    P[::7] = 0.0
    P[3::7, 2, :] = P[3::7, :, 2] = 0.0
    z = sensor.h(x) * random.uniform(0.95, 1.05, (RUNS, 1))
    z[::5] = np.nan
    skip = random.random(RUNS) < 0.3
    h, H, R = sensor.linearize(x)
    # what the sensor does not see
    aside = np.cross(H[2::7, 0], random.normal(size=(len(H[2::7]), 3)))
    P[2::7] = aside[:, :, None] * aside[:, None, :]  # H P Hᵀ is what rounding leaves of 0
    prior, reading = Gaussian(x, P), Linearized(z, h, sensor.residual(z, h), H, R)
    belief, correction = corrected(prior, reading, skip, gate, (2,))
    with taking(name):
        fast, told = unrolled.updated(prior, reading, skip, gate, 2)
    assert unrolled.knows(x, z, H)
    np.testing.assert_allclose(fast.mean, belief.mean, **NEAR)
    np.testing.assert_allclose(fast.covariance, belief.covariance, **NEAR)
    for part in ("predicted", "innovation", "R", "S", "H", "K", "nis", "refused"):
        expected = getattr(correction, part)
        scale = max(1.0, float(np.nanmax(np.abs(expected), initial=0.0)))
        np.testing.assert_allclose(
            getattr(told, part), expected, rtol=1e-11, atol=1e-12 * scale, err_msg=part
        )
    assert len(set(told.refused.tolist())) > 2
    assert definite(fast.covariance)


@backends
def test_a_sharp_laser_leaves_its_own_doubt_and_no_rounding(name):
    """A beam along x, the heading known: of 0.01 m² its R is left, be that as small as it may."""
    x, P = np.tile([3.0, 4.0, 0.0], (RUNS, 1)), np.tile(np.diag([0.01, 0.01, 0.0]), (RUNS, 1, 1))
    laser = Laser(ROOM, 0.0, 1e-8)
    with taking(name):
        posterior, correction = EKF().update(Gaussian(x, P), laser, np.full((RUNS, 1), 7.0))
    np.testing.assert_allclose(posterior.covariance[:, 0, 0], correction.R[:, 0, 0], rtol=1e-9)


@backends
def test_a_beam_along_a_wall_among_others(name, random):
    x = random.uniform((1, 1, -3), (9, 7, 3), (RUNS, 3))
    x[::3] = [-1.0, 0.0, 0.0]
    laser = Laser(ROOM, 0.0, 0.02)
    with taking(name):
        many = laser.linearize(x)
    assert np.isnan(many[0][::3]).all()
    for k in range(RUNS):
        for each, one in zip(many, laser.linearize(x[k]), strict=True):
            np.testing.assert_allclose(each[k], one, **NEAR)


@backends
def test_an_update_changes_nothing_that_it_was_given(name, random):
    (x, P), laser, motion = classroom(random, (RUNS,))
    z, u = laser.h(x) + 0.01, random.uniform(-1, 1, (RUNS, 2))
    before = [each.copy() for each in (x, P, z, u)]
    with taking(name):
        EKF(0.5).update(Gaussian(x, P), laser, z, np.arange(RUNS) % 2 == 0)
        EKF().predict(Gaussian(x, P), motion, u)
        nees(Gaussian(x, P), x + 0.1)
    for each, kept in zip((x, P, z, u), before, strict=True):
        np.testing.assert_array_equal(each, kept)


@backends
def test_the_nees_of_many_runs_is_that_of_each(name, random):
    P = covariance(random, RUNS, 3) * 0.01
    P[::4, 2, :] = P[::4, :, 2] = 0.0  # ranks of 3, 2, 1 and 0 side by side
    P[::8, 1, :] = P[::8, :, 1] = 0.0
    P[::16] = 0.0
    P[1::9], P[2::9] = (covariance(random, len(P[i::9]), 3, rank=i) * 0.01 for i in (1, 2))
    e = random.normal(size=(RUNS, 3)) * 0.1
    e[::2] = np.matvec(P[::2], e[::2])
    for n in (3, 2):
        with taking(name):
            value, rank, impossible = squared_mahalanobis(e[:, :n], P[:, :n, :n])
        for k in range(RUNS):
            one = squared_mahalanobis(e[k : k + 1, :n], P[k : k + 1, :n, :n])
            assert (rank[k], impossible[k]) == (one[1][0], one[2][0])
            assert impossible[k] or value[k] == pytest.approx(float(one[0][0]), rel=1e-9, abs=1e-12)
        assert set(rank.tolist()) == set(range(n + 1))


@backends
@pytest.mark.parametrize(
    ("made", "reasons"), [(rich(), 3), (unbounded(), 3), (rich(gate=None, guard="skip"), 3)]
)
def test_a_run_of_a_study_is_that_run_alone(name, made, reasons):
    runs, met = np.arange(900, 1024), set()
    some = [0, 1, 60, 123]
    alone = [list(play(dataclasses.replace(made, run=int(runs[k])))) for k in some]
    with taking(name):
        for i, step in enumerate(play(made, runs)):
            for k, one in zip(some, (steps[i] for steps in alone), strict=True):
                np.testing.assert_allclose(step.entry.truth[k], one.entry.truth, **NEAR)
                np.testing.assert_allclose(
                    step.posterior.mean[k], one.posterior.mean, rtol=1e-12, atol=1e-11
                )
                np.testing.assert_allclose(
                    step.posterior.covariance[k], one.posterior.covariance, **NEAR
                )
                assert step.nees.dof[k] == one.nees.dof
                if one.correction:
                    assert step.correction.refused[k] == one.correction.refused
            if step.correction:
                met |= set(step.correction.refused.tolist())
    assert len(met) >= reasons, [Refused(each) for each in met]


def test_nothing_in_a_map_without_walls_is_met(random):
    x = classroom(random, (RUNS,))[0].mean
    for name in BACKENDS:
        with taking(name):
            h, H, R = Laser(Walls.of({}), 0.1, 0.01).linearize(x)
        assert np.isnan(h).all()
        assert np.isnan(R).all()
        assert (H == 0).all()


def test_lanes_are_zeros_in_the_shape_asked_for():
    made = lanes((4, 5), 3, 2)
    assert made.shape == (4, 5, 3, 2)
    assert (made == 0).all()
    assert made.strides == (40, 8, 320, 160)
