"""A robot that is carried away: doubt, and where it is sought."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.diagnostics.verdict import lost
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.mixture.mhekf import MHEKF
from ekfsim.filters.mixture.places import mixed
from ekfsim.filters.mixture.relocating import (
    FEWEST,
    MOST,
    ODDS,
    SURPRISE,
    Found,
    Memory,
    sought,
    span,
)
from ekfsim.localization import play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.study.block import run_block

KIDNAP = """
world: furnished-room
seed: 3
commands:
  - repeat: {times: 2, commands: [
      move: {distance: 0.8, angle: 30}, sense: {angle: 0}, sense: {angle: 90},
      sense: {angle: -90}, sense: {angle: 180}]}
  - kidnap: {x: 6.6, y: 5.6, theta: 160}
  - repeat: {times: 5, commands: [
      sense: {angle: 0}, sense: {angle: 45}, sense: {angle: 90}, sense: {angle: -90},
      sense: {angle: 180}, move: {distance: 0.4, angle: 20}]}
"""
L_ROOM = Walls.of({"boundary": np.array([[0, 0], [7, 0], [7, 3], [3, 3], [3, 5], [0, 5]], float)})


def remembered(surprises, used=True):
    memory, laser = Memory.empty(()), Laser(L_ROOM, 0.0, 0.02)
    for one in surprises:
        memory = memory.read(laser, np.array([1.0]), np.array(one), np.array(used))
    return memory


def test_doubt_is_the_sum_since_it_was_least():
    memory = remembered([-1.0, 2.0, 2.5, -0.5, 9.0])
    assert float(memory.doubt) == pytest.approx(ODDS + 2.0 + 2.5 - 0.5 + SURPRISE)
    assert int(memory.since) == 4
    assert not memory.lost
    assert remembered([9.0] * 4).lost  # 4 · 3 > 9.2
    assert not remembered([90.0] * (FEWEST - 1) + [-1.0]).lost


def test_a_reading_that_is_refused_or_missing_adds_no_doubt():
    assert float(remembered([9.0] * 10, used=False).doubt) == ODDS
    assert float(remembered([math.nan] * 10).doubt) == ODDS


def test_no_more_is_remembered_than_is_sought_by():
    memory, motion = remembered([1.0] * 30), MoveTurn(0.1, 0.1)
    assert len(memory.heard) == MOST
    memory = memory.moved(motion, np.zeros(2))
    assert len(memory.heard) == MOST + 1
    assert len(Memory.empty(()).moved(motion, np.zeros(2)).heard) == 0


def test_a_span_is_the_density_of_anything_between():
    assert span(np.array([[1.0], [math.nan], [5.0], [3.0]])) == pytest.approx(-math.log(4.0))
    assert math.isnan(span(np.full((3, 1), math.nan)))


@pytest.mark.parametrize("silent", [(), (2,), (0, 1)])
def test_a_place_is_found_by_what_is_read_there(silent):
    """Exact beams from two places of a room without symmetry; one without an echo tells nothing."""
    truth, motion, u = np.array([2.1, 3.4, 0.7]), MoveTurn(0.01, 0.01), np.array([0.3, 0.4])
    memory, x = Memory.empty((1,)), truth
    for k in range(8):
        if k == 4:
            memory, x = memory.moved(motion, u[None]), motion.f(x, u)
        laser = Laser(L_ROOM, k * math.pi / 4 + 0.1 * (k > 3), 0.01)
        z = np.where(k in silent, math.nan, laser.h(x)[None])
        memory = memory.read(laser, z, np.array([9.0]), np.array([True]))
    random = np.random.default_rng(1)
    places = random.uniform([0, 0, -math.pi], [7, 5, math.pi], (2048, 3))
    places = places[(places[:, 0] < 3) | (places[:, 1] < 3)]
    found = sought(memory.last(8, np.array([True])), places, (2,))
    best = int(found.log[0].argmax())
    assert_allclose(found.means[0, best], x, atol=0.02)


@pytest.mark.parametrize("doubt", [-1.0, 0.0, 2.0])
def test_places_that_are_found_weigh_as_much_as_the_doubt(doubt):
    """As log odds: e to the doubt times as much as all that was believed before, in one run."""
    before = mixed(Gaussian(np.zeros((1, 3)), 0.01 * np.eye(3)[None]))
    log = np.log([[3.0, 1.0]])
    means = np.array([[[5.0, 0, 0], [9.0, 0, 0]]])
    found = Found(means, np.broadcast_to(0.01 * np.eye(3), (1, 2, 3, 3)), log)
    after = MHEKF()._with(found, np.array([doubt]), before)
    each = zip(after.means[0, :, 0].tolist(), after.weights[0].tolist(), strict=True)
    weights = {x: w for x, w in each if w > 0}
    share = math.exp(doubt) / (1 + math.exp(doubt))
    assert weights[0.0] == pytest.approx(1 - share)
    assert (weights[5.0], weights[9.0]) == pytest.approx((share * 3 / 4, share / 4))


def test_a_robot_that_is_carried_away_is_found_again():
    carried = replace(load_scene(KIDNAP), filter="mhekf")
    shares = {}
    for name in ("ekf", "mhekf"):
        tally = run_block(replace(carried, filter=name), 0, 60)
        shares[name] = sum(tally.lost_from.values()) / 60
    assert shares["ekf"] > 0.9
    assert shares["mhekf"] < 0.9 / 4


def test_a_run_that_is_found_again_is_the_same_alone():
    carried = replace(load_scene(KIDNAP), filter="mhekf")
    *_, many = play(carried, np.arange(5))
    *_, one = play(replace(carried, run=3))
    assert_allclose(many.posterior.mean[3], one.posterior.mean, atol=1e-6)
    assert one.nees is not None
    assert not lost(one.nees)
