"""Against the filter on matrices, and what an invariant filter must do."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from numerics import covariance
from problems import landmark
from scipy.linalg import expm

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.cures.invariant import Invariant
from ekfsim.filters.ekf import EKF
from ekfsim.localization import play
from ekfsim.models.layout import SPEED_POSE
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.position import Position

ROOT = Path(__file__).parents[3]
seeds = st.integers(0, 2**32 - 1)
MOTION = MoveTurn(0.05, 0.1)
J = np.array([[0.0, -1.0], [1.0, 0.0]])


def hat(ξ):
    """A twist (x, y, θ) as a matrix."""
    return np.array([[0, -ξ[2], ξ[0]], [ξ[2], 0, ξ[1]], [0, 0, 0.0]])


def as_matrix(x):
    c, s = math.cos(x[2]), math.sin(x[2])
    return np.array([[c, -s, x[0]], [s, c, x[1]], [0, 0, 1.0]])


def as_pose(χ):
    return np.array([χ[0, 2], χ[1, 2], math.atan2(χ[1, 0], χ[0, 0])])


def frame(θ):
    """T with δ = T ξ: from the robot's frame to x, y, θ."""
    return as_matrix([0, 0, θ])


def adjoint(U):
    Ad = np.eye(3)
    Ad[:2, :2] = U[:2, :2]
    Ad[:2, 2] = -J @ U[:2, 2]
    return Ad


class OnMatrices:
    """χ and P of ξ, by the formulas of the group alone: no model of the package."""

    def __init__(self, belief):
        x, P = belief
        T = frame(x[2])
        self.χ, self.P = as_matrix(x), T.T @ P @ T

    def predict(self, u):
        """U = T(d) R(a): a and then d, seen from where they end."""
        d, a = u
        U = as_matrix([d, 0, 0]) @ as_matrix([0, 0, a])
        G = np.array([[math.cos(a), 0], [-math.sin(a), 0], [0, 1.0]])
        M = np.diag([(0.05 * d) ** 2, (0.1 * a) ** 2])
        F = adjoint(np.linalg.inv(U))
        self.χ, self.P = self.χ @ U, F @ self.P @ F.T + G @ M @ G.T

    def see(self, mark, z, R):
        """Range and bearing of y = χ⁻¹ m, dy = −ξ_p − J y ξ_θ."""
        y = (np.linalg.inv(self.χ) @ [*mark, 1.0])[:2]
        r = np.hypot(*y)
        polar = np.array([y / r, J @ y / r**2])
        H = polar @ np.column_stack([-np.eye(2), -J @ y])
        ν = z - [r, math.atan2(y[1], y[0])]
        ν[1] = math.remainder(ν[1], 2 * math.pi)
        self.use(H, ν, R)

    def fix(self, z, R):
        """The position, p + R ξ_p"""
        H = np.column_stack([self.χ[:2, :2], np.zeros(2)])
        self.use(H, z - self.χ[:2, 2], R)

    def use(self, H, ν, R):
        K = self.P @ H.T @ np.linalg.inv(H @ self.P @ H.T + R)
        self.χ = self.χ @ expm(hat(K @ ν))
        self.P = (np.eye(3) - K @ H) @ self.P

    def same(self, belief):
        T = frame(as_pose(self.χ)[2])
        assert as_matrix(belief.mean) == pytest.approx(self.χ, abs=1e-10)
        assert belief.covariance == pytest.approx(T @ self.P @ T.T, abs=1e-10)


@settings(max_examples=15)
@given(seeds)
def test_it_is_the_filter_on_matrices(seed):
    random = np.random.default_rng(seed)
    belief = Gaussian(random.uniform(-3, 3, 3), 0.3 * covariance(random, 3))
    filter, other = Invariant(), OnMatrices(belief)
    for _ in range(4):
        u = random.uniform(-1, 1, 2)
        belief, _ = filter.predict(belief, MOTION, u)
        other.predict(u)
        other.same(belief)
        mark = random.uniform(4, 8, 2)
        z = np.array([random.uniform(3, 9), random.uniform(-3, 3)])
        belief, _ = filter.update(belief, landmark(*mark), z)
        other.see(mark, z, np.diag([0.1**2, 0.02**2]))
        other.same(belief)
        z = belief.mean[:2] + random.normal(size=2)
        belief, _ = filter.update(belief, Position(0.2, 0.3), z)
        other.fix(z, np.diag([0.2**2, 0.3**2]))
        other.same(belief)


def gains(filter, start, P, random, fixes):
    """What each fix would do in the robot's frame, by an innovation in that frame; P : of ξ"""
    T = frame(start[2])
    belief, made = Gaussian(start, T @ P @ T.T), []
    for u in fixes:
        belief, _ = filter.predict(belief, MOTION, u)
        R = frame(belief.mean[2])
        z = belief.mean[:2] + random.normal(size=2)
        belief, told = filter.update(belief, Position(0.4, 0.4), z)
        made.append(R.T @ told.K @ R[:2, :2])
    return np.array(made)


def test_the_gains_for_fixes_depend_on_no_estimate():
    """The property that gives the filter its name: alike wherever the robot is believed to be, and
    whatever was read. Not so of the EKF."""
    random = np.random.default_rng(3)
    P, fixes = covariance(random, 3), random.uniform(-1, 1, (6, 2))
    for filter, alike in ((Invariant(), True), (EKF(), False)):
        one, other = (gains(filter, random.uniform(-3, 3, 3), P, random, fixes) for _ in range(2))
        assert np.abs(one[0] - other[0]).max() < 1e-12  # nothing was read before
        assert (np.abs(one - other).max() < 1e-12) == alike


def test_the_gain_for_a_landmark_depends_on_what_is_predicted_alone():
    """On y = χ⁻¹ m, which the mean moves: no other place and heading from which the same is seen
    has another gain in the robot's frame."""
    random = np.random.default_rng(4)
    P, y = covariance(random, 3), np.array([3.0, 1.0, 1.0])
    made = []
    for _ in range(2):
        x = random.uniform(-3, 3, 3)
        T = frame(x[2])
        mark = (as_matrix(x) @ y)[:2]
        _, told = Invariant().update(
            Gaussian(x, T @ P @ T.T), landmark(*mark), np.array([3.0, 0.2])
        )
        made.append(T.T @ told.K)
    assert made[0] == pytest.approx(made[1], abs=1e-12)


def test_from_the_right_the_mean_would_be_the_same():
    """exp(ξ) χ⁻ with the twist in the world's frame that has the same chord."""
    random = np.random.default_rng(7)
    prior = Gaussian(random.uniform(-3, 3, 3), covariance(random, 3))
    (x, _), told = Invariant().update(prior, landmark(5.0, 4.0), np.array([3.0, 1.0]))
    *δp, δθ = told.K @ told.innovation
    ξ = np.array([*(δp - δθ * J @ prior.mean[:2]), δθ])
    assert as_matrix(x) == pytest.approx(expm(hat(ξ)) @ as_matrix(prior.mean), abs=1e-12)


def test_who_drove_straight_stays_on_the_arc():
    """The start is known and the heading is not: after d the robot is on a circle of d about the
    start, and so is the estimate, whatever a fix says; its ellipse lies along the circle."""
    d, σ = 3.0, 0.8
    first = Gaussian(np.zeros(3), np.diag([0, 0, σ**2]))
    moved, _ = Invariant().predict(first, MoveTurn(0, 0), np.array([d, 0.0]))
    z = d * np.array([math.cos(1.0), math.sin(1.0)])
    (x, P), _ = Invariant().update(moved, Position(0.05, 0.05), z)
    assert np.hypot(*x[:2]) == pytest.approx(d, rel=1e-12)
    assert math.atan2(x[1], x[0]) == pytest.approx(x[2], rel=1e-12)
    assert P[:2, :2] @ x[:2] == pytest.approx(0, abs=1e-12)
    (straight, _), _ = EKF().update(moved, Position(0.05, 0.05), z)
    assert np.hypot(*straight[:2]) > d + 0.5


@settings(max_examples=15)
@given(seeds, st.floats(-3, 3), st.floats(-5, 5), st.floats(-5, 5))
def test_the_world_may_be_turned_and_moved(seed, turn, dx, dy):
    moved = as_matrix([dx, dy, turn])
    T = frame(turn)

    def run(world):
        random = np.random.default_rng(seed)
        x, P = random.uniform(-2, 2, 3), covariance(random, 3)
        if world:
            x, P = as_pose(moved @ as_matrix(x)), T @ P @ T.T
        belief = Gaussian(x, P)
        for _ in range(3):
            belief, _ = Invariant().predict(belief, MOTION, random.uniform(-1, 1, 2))
            mark = np.array([*random.uniform(5, 8, 2), 1.0])
            seen = landmark(*((moved @ mark) if world else mark)[:2])
            z = np.array([random.uniform(3, 9), random.uniform(-1, 1)])
            belief, _ = Invariant().update(belief, seen, z)
        return belief

    (x, P), (y, Q) = run(False), run(True)
    assert as_matrix(y) == pytest.approx(moved @ as_matrix(x), abs=1e-7)
    assert pytest.approx(T @ P @ T.T, abs=1e-7) == Q


def test_small_corrections_are_the_ekfs():
    """The two part by the square of the correction."""
    random = np.random.default_rng(5)
    prior = Gaussian(np.array([1.0, 2.0, 0.5]), covariance(random, 3))
    sensor = landmark(5.0, 4.0)
    off = []
    for ε in (1e-2, 1e-3):
        z = sensor.h(prior.mean) + ε * np.array([1.0, 0.5])
        (x, P), _ = Invariant().update(prior, sensor, z)
        (y, Q), _ = EKF().update(prior, sensor, z)
        off.append((np.abs(x - y).max(), np.abs(P - Q).max()))
    assert off[0][0] / off[1][0] == pytest.approx(100, rel=0.05)
    assert off[0][1] / off[1][1] == pytest.approx(10, rel=0.05)  # P turns with the heading


def test_it_is_seldom_lost_where_the_heading_was_hardly_known():
    """2 m among landmarks; of 1000 runs 27.3 % of the EKF's are lost, 3.2 % of these."""
    drive = [{"v": 0.5, "omega": 0, "for": 4}]
    world = yaml.safe_load((ROOT / "worlds/landmarks.yaml").read_text(encoding="utf-8"))
    world["start"] |= {"sigma": {"theta": 60}}
    world["robot"] = {"rate": 20}
    scene = load_scene({"world": "landmarks", "seed": 1, "drive": drive}, world)
    runs = np.arange(150)
    lost = {}
    for name in ("ekf", "invariant"):
        *_, last = play(replace(scene, filter=name), runs)
        lost[name] = np.mean(last.nees.value > 16.27)
    assert lost["ekf"] > 0.15
    assert lost["invariant"] < 0.09


def test_what_else_the_state_holds_is_added_to():
    """The mower of the satellites: v, φ, x, y. With the heading certain it is the EKF."""
    random = np.random.default_rng(6)
    sensor = Position(0.2, 0.2, SPEED_POSE)
    P = covariance(random, 4)
    filter = Invariant(headings=(1,), pose=SPEED_POSE.places)
    ekf = EKF(headings=(1,))
    prior, z = Gaussian(np.array([0.5, 1.0, 2.0, 3.0]), P), np.array([2.5, 3.5])
    (x, _), told = filter.update(prior, sensor, z)
    (y, _), _ = ekf.update(prior, sensor, z)
    assert x[:2] == pytest.approx(y[:2], abs=1e-14)
    δ = told.K @ told.innovation
    arc = expm(hat([*(frame(1.0)[:2, :2].T @ δ[2:]), δ[1]]))
    assert x[2:] == pytest.approx((as_matrix([2.0, 3.0, 1.0]) @ arc)[:2, 2], abs=1e-12)
    P[1] = P[:, 1] = 0
    (x, P), _ = filter.update(prior, sensor, z)
    (y, Q), _ = ekf.update(prior, sensor, z)
    assert x == pytest.approx(y, abs=1e-14)
    assert pytest.approx(Q, abs=1e-14) == P
