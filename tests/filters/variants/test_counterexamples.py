"""The two switches of the classroom: C_v from the reading, and σ_xθ and σ_yθ dropped."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scenes import scene

from ekfsim.commands import Move, Sense
from ekfsim.files.results.trace import Trace
from ekfsim.filters.tuning import Tuning
from ekfsim.localization import play
from ekfsim.world import Faults

BY_READING, DROPPED = Tuning(range_variance="reading"), Tuning(cross_covariances="dropped")
COURSE = tuple(c for k in range(6) for c in (Move(0.4, 0.7), Sense(0.5 * k), Sense(-0.9)))


def spoiled(tuning, name="ekf", short=0.0, **otherwise):
    """A drive among the walls of a room, from an unsure start."""
    made = scene(*COURSE, sigma=(0.05, 0.05, 0.03), seed=4, filter=name, **otherwise)
    return replace(
        made, tuning=tuning, world=replace(made.world, faults=Faults(short_returns=short))
    )


def used(steps):
    return [step for step in steps if step.correction is not None and step.correction.refused == 0]


@pytest.mark.parametrize("name", ["kf", "kf-nominal", "ekf", "iekf", "ukf", "pf"])
def test_c_v_is_of_the_reading(name):
    made = spoiled(BY_READING, name, short=0.5)
    ratio = made.world.told.noise.range
    steps = used(play(made))
    assert len(steps) > 4
    for step in steps:
        assert_allclose(step.correction.R, [np.square(ratio * step.entry.given.z)], rtol=1e-12)
    by_prediction = used(play(replace(made, tuning=Tuning())))
    assert any(abs(float(one.correction.R[0, 0] / other.correction.R[0, 0]) - 1) > 0.1
               for one, other in zip(steps, by_prediction, strict=False))  # fmt: skip


def test_the_ekf_weighs_the_reading_by_it():
    step = used(play(spoiled(BY_READING)))[3]
    (x, P), c, z = step.prior, step.correction, step.entry.given.z
    H = c.H
    S = float(H[0] @ P @ H[0]) + (0.01 * z[0]) ** 2
    K = P @ H[0] / S
    assert_allclose(c.S, [[S]], rtol=1e-12)
    assert_allclose(step.posterior.mean[:2], (x + K * (z[0] - c.predicted[0]))[:2], rtol=1e-12)
    assert_allclose(step.posterior.covariance, P - np.outer(K, H[0] @ P), atol=1e-14)


def test_trace_and_narrative_hold_the_c_v_that_was_used(tmp_path):
    made = spoiled(BY_READING, short=0.5)
    file = tmp_path / "trace.jsonl"
    with file.open("w") as out:
        sink = Trace(out, made, 0.954)
        for step in play(made):
            sink.write(step)
    lines = [json.loads(line) for line in file.read_text().splitlines()]
    told = [
        (line["range_variance"], line["range"])
        for line in lines
        if line["type"] == "sense" and line["updated"]
    ]
    assert len(told) > 4
    assert_allclose(
        [variance for variance, _ in told], [(0.01 * z) ** 2 for _, z in told], rtol=1e-12
    )


def test_without_an_echo_the_reading_is_refused_as_ever():
    nowhere = scene(Sense(0.0), Move(1, 0), Sense(1.0), boundary=None)
    for one, other in zip(play(replace(nowhere, tuning=BY_READING)), play(nowhere), strict=True):
        assert_array_equal(one.posterior.mean, other.posterior.mean)
        if one.correction is not None:
            assert one.correction.refused == other.correction.refused != 0


@pytest.mark.parametrize("name", ["kf", "kf-nominal", "ekf", "iekf", "ukf"])
def test_the_cross_covariances_are_dropped_after_every_step(name):
    for step in play(spoiled(DROPPED, name)):
        P = step.posterior.covariance
        assert_array_equal(P[:2, 2], 0.0)
        assert_array_equal(P[2, :2], 0.0)
        assert P[0, 1] != 0 or step.entry.index < 3
        assert np.linalg.eigvalsh(P)[0] >= -1e-15


def test_a_filter_that_remembers_more_than_a_gaussian_goes_on_knowing_it():
    kept, dropped = (list(play(spoiled(tuning, "kf-nominal"))) for tuning in (Tuning(), DROPPED))
    assert [step.posterior.inputs for step in dropped[1:]] == [
        step.posterior.inputs for step in kept[1:]
    ]
    assert dropped[-1].posterior.inputs == 6


def test_what_is_dropped_teaches_the_heading_nothing():
    """One beam square to a wall: ∂h/∂θ = 0, and K_θ = (σ_xθ ∂h/∂x + σ_yθ ∂h/∂y)/S."""
    made = scene(
        Move(3.0, 0.0), Sense(np.pi / 2), start=(1.0, 4.0, 0.0), sigma=(0.0, 0.0, 0.1), seed=2
    )
    kept, dropped = (list(play(replace(made, tuning=tuning)))[-1] for tuning in (Tuning(), DROPPED))
    assert abs(kept.correction.H[0, 2]) < 0.2 * abs(kept.correction.H[0, 1])
    before, after, none = (P[2, 2] ** 0.5 for P in (kept.prior.covariance,
    kept.posterior.covariance,
                                                    dropped.posterior.covariance))  # fmt: skip
    assert after < 0.3 * before
    assert none > 0.97 * before
    assert_allclose(dropped.posterior.covariance[1, 1], kept.posterior.covariance[1, 1], rtol=0.1)


@pytest.mark.parametrize("tuning", [BY_READING, DROPPED])
@pytest.mark.parametrize("name", ["ekf", "ukf"])
def test_many_runs_are_spoiled_as_each_alone(tuning, name):
    made = spoiled(tuning, name, short=0.3)
    *_, together = play(made, np.arange(5))
    for run in range(5):
        *_, alone = play(replace(made, run=run))
        assert_allclose(together.posterior.mean[run], alone.posterior.mean, atol=1e-11)
        assert_allclose(together.posterior.covariance[run], alone.posterior.covariance, atol=1e-12)
