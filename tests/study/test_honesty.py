"""Honest statistics: a filter that is told the truth about its noise is as sure as it may be, and
no surer.

The bounds are two-sided at 1 in 100 000 for each number that is looked at; there are a few hundred
of them. Each test has a twin in which the filter is told a wrong noise, and which the same bounds
find out.
"""

import math
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scenes import NOISE, scene
from scipy.stats import binom, chi2, norm

from ekfsim.commands import Move, Sense
from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.diagnostics.nees import nees
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.kf import KF
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_factor
from ekfsim.models.noise import independent
from ekfsim.models.protocols import Quantity
from ekfsim.models.sensors.position import Position
from ekfsim.simulation import simulate
from ekfsim.study.block import run_block
from ekfsim.study.plan import Case
from ekfsim.study.results import Result
from ekfsim.study.verdict import Verdict, Word

RUNS, STEPS = 100_000, 20
ONCE = 1e-5  # how often an honest number may lie outside its bounds
A = np.array([[1.0, 0.1, 0.4], [0.0, 0.95, -0.3], [0.0, 0.0, 0.9]])
SIGMAS = np.array([0.05, 0.08, 0.03])  # of the three inputs: m, m, rad
FIRST = np.array([[0.04, 0.012, 0.002], [0.012, 0.09, -0.003], [0.002, -0.003, 0.01]])  # P₀


@dataclass
class Drift:
    """x = A x + u, with a noise of u that is always the same."""

    told: float = 1.0  # the σ that the filter is told, as a share of the true one

    @property
    def inputs(self):
        return Quantity("u_x", "m"), Quantity("u_y", "m"), Quantity("u_θ", "rad")

    def f(self, x, u):
        return np.matvec(A, x) + u

    def linearize(self, x, u):
        return self.f(x, u), A, np.eye(3), independent(*(self.told * SIGMAS)), 0.0


@dataclass
class Seen:
    """What is counted of 100 000 runs after each step."""

    inside: int
    held: int
    nees: float  # Σ
    nis: float


@cache
def seen(told: float = 1.0) -> tuple[Seen, ...]:
    """The linear filter on a linear world; `told` : how large it believes σ of the motion to be, as
    a share of it."""
    draw, motion, sensor = np.random.default_rng(20), Drift(told), Position(0.1, 0.15)
    mean = np.array([1.0, 2.0, 0.1])
    truth = draw.multivariate_normal(mean, FIRST, RUNS)
    belief = Gaussian(np.broadcast_to(mean, (RUNS, 3)), np.broadcast_to(FIRST, (RUNS, 3, 3)))
    filter, counts = KF(mean), list[Seen]()
    for k in range(STEPS):
        u = np.array([0.3 * math.cos(k), 0.3 * math.sin(k), 0.02])
        truth = np.matvec(A, truth) + u + SIGMAS * draw.standard_normal((RUNS, 3))
        belief, _ = filter.predict(belief, motion, u)
        z = truth[:, :2] + np.array([0.1, 0.15]) * draw.standard_normal((RUNS, 2))
        belief, correction = filter.update(belief, sensor, z)
        measured = nees(belief, truth)
        assert (measured.dof == 3).all()
        counts.append(
            Seen(
                int(np.count_nonzero(inside_ellipse(belief, truth, 0.954))),
                int(np.count_nonzero(inside_cone(belief, truth, 0.954))),
                float(np.sum(measured.value)),
                float(np.sum(correction.nis)),
            )
        )
    return tuple(counts)


def honest(runs: int, probability: float) -> bool:
    """Whether so many of all runs may be, where each is with this probability."""
    low, high = binom.interval(1 - ONCE, RUNS, probability)
    return low <= runs <= high


def chance(total: float, dof: int) -> bool:
    """Whether a χ² variable of so many degrees of freedom may be this."""
    low, high = chi2.interval(1 - ONCE, dof)
    return low <= total <= high


CONE = 2 * norm.cdf(cone_factor(0.954)) - 1


@pytest.mark.parametrize("step", range(STEPS))
def test_a_linear_filter_is_as_sure_as_it_may_be(step):
    """Coverage of the 95.4 % ellipse and of the cone, mean NEES (3 degrees of freedom) and mean NIS
    (2)."""
    found = seen()[step]
    assert honest(found.inside, 0.954)
    assert honest(found.held, CONE)
    assert chance(found.nees, 3 * RUNS)
    assert chance(found.nis, 2 * RUNS)


@pytest.mark.parametrize("told", [0.95, 1.05])
def test_five_percent_of_sigma_too_few_or_too_many_are_found_out(told):
    last = seen(told)[-1]
    assert not honest(last.inside, 0.954)
    assert not honest(last.held, CONE)
    assert not chance(last.nees, 3 * RUNS)
    assert not chance(last.nis, 2 * RUNS)
    assert (last.nees > 3 * RUNS) == (last.nis > 2 * RUNS) == (told < 1)


@cache
def drawn() -> Array:
    """Every noise of two moves and two senses, in units of the σ that it is said to have : (RUNS,
    10)"""
    course = (Move(2.0, -0.5), Sense(0.3), Move(-1.5, 0.6), Sense(-0.2))
    entries = list(simulate(scene(*course, start=(4, 4, 0.2), seed=8), np.arange(RUNS)))
    columns = []
    for before, entry in pairwise(entries):
        asked, was, now = entry.command, before.truth, entry.truth
        if isinstance(asked, Move):
            way = now[:, :2] - was[:, :2]
            driven = way @ np.array([1, 0]) * np.cos(was[:, 2]) + way @ np.array([0, 1]) * np.sin(
                was[:, 2]
            )
            turned = now[:, 2] - was[:, 2]
            d, a = entry.given.u.T
            columns += [
                (driven - asked.distance) / (NOISE.execution_distance * abs(asked.distance)),
                (turned - asked.angle) / (NOISE.execution_angle * abs(asked.angle)),
                (d - driven) / (NOISE.odometry_distance * abs(driven)),
                (a - turned) / (NOISE.odometry_angle * abs(turned)),
            ]
        else:
            true = (10 - now[:, 0]) / np.cos(now[:, 2] + asked.angle)  # to the wall at x = 10 m
            assert (abs(now[:, 1] + true * np.sin(now[:, 2] + asked.angle) - 4) < 4).all()
            columns.append((entry.given.z[:, 0] - true) / (NOISE.range * true))
    return np.stack(columns, axis=-1)


def test_the_simulated_noises_have_the_stated_sigma():
    noises, reach = drawn(), norm.isf(ONCE / 2)
    assert noises.shape == (RUNS, 10)
    assert (abs(np.mean(noises, axis=0)) < reach / math.sqrt(RUNS)).all()
    low, high = np.sqrt(np.array(chi2.interval(1 - ONCE, RUNS - 1)) / (RUNS - 1))
    assert ((np.std(noises, axis=0, ddof=1) > low) & (np.std(noises, axis=0, ddof=1) < high)).all()


def test_the_simulated_noises_are_gaussian():
    for probability in (0.5, 0.954, 0.999):
        inside = np.count_nonzero(abs(drawn()) < norm.isf((1 - probability) / 2), axis=0)
        assert all(honest(runs, probability) for runs in inside)


def test_no_noise_knows_of_another():
    """Neither within a command nor from one to the next."""
    correlation = np.corrcoef(drawn().T) - np.eye(10)
    assert (abs(correlation) < norm.isf(ONCE / 2) / math.sqrt(RUNS)).all()


@cache
def found(name: str, filter: str = "ekf", told: float = 1.0) -> Result:
    """2048 runs of a scene whose filter is told so much of the true σ."""
    asked = made() if name == "made" else read_scene(packaged("commands")[name]).get()
    noise = asked.world.noise
    believed = replace(noise, **{key: told * value for key, value in vars(noise).items()})
    world = replace(asked.world, told=replace(asked.world.told, noise=believed))
    asked = replace(asked, filter=filter, world=world)
    total = run_block(asked, 0, 1024) + run_block(asked, 1024, 1024)
    return Result(Case((), asked), total)


def made():
    """An empty room, a start that is uncertain, and beams that meet a wall's middle."""
    course = [c for _ in range(12) for c in (Sense(0.1), Sense(1.7), Move(0.4, 0.5), Sense(-1.4))]
    return scene(*course, start=(5, 4, 0), sigma=(0.1, 0.15, 0.05), seed=4)


@pytest.mark.parametrize("filter", ["ekf", "iekf", "ukf"])
@pytest.mark.parametrize("name", ["diverge-00-control", "made"])
def test_a_filter_that_knows_its_noise_is_consistent_in_an_empty_room(name, filter):
    verdict = Verdict(found(name, filter))
    assert verdict.at_end.word is Word.CONSISTENT
    assert verdict.at_end.decided
    assert verdict.on_the_way.nis.value == pytest.approx(1.0, abs=0.1)
    # the vague start is a little curved
    beyond = [at.above_999.value for at in verdict.on_the_way.steps]
    assert beyond == [] if name == "diverge-00-control" else max(beyond, default=0.0) < 0.03


@pytest.mark.parametrize(("told", "word"), [(0.7, Word.OVER_CONFIDENT), (1.4, Word.OVER_CAUTIOUS)])
@pytest.mark.parametrize("name", ["diverge-00-control", "made"])
def test_one_that_is_told_another_noise_is_not(name, told, word):
    verdict = Verdict(found(name, "ekf", told))
    assert (verdict.at_end.word, verdict.on_the_way.word) == (word, word)
    assert verdict.at_end.decided
    assert verdict.on_the_way.decided
