"""A hunt for a start or for a told number: the same commands, and what is changed is the smallest
that does it.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from ekfsim.commands import Move, Sense
from ekfsim.errors import RunError
from ekfsim.files.scenes.load import load_scene, load_world
from ekfsim.hunting.changes.starts import Starts, rounder
from ekfsim.hunting.changes.told import Needed, needed, untruly
from ekfsim.hunting.changes.variants import Started, Told
from ekfsim.hunting.crew import crew
from ekfsim.hunting.goals import Count, Lost
from ekfsim.hunting.hunt import Asked, hunt
from ekfsim.hunting.worlds import without

COMMANDS = (Move(1.0, math.radians(90)), Sense(0.0))
ROOM = replace(load_scene({"world": "room", "commands": []}), commands=COMMANDS)
FIELD = {
    "name": "field",
    "start": {"x": 1, "y": 1, "theta": 0},
    "noise": {
        "executionDstSigmaRatio": 0.05,
        "executionAngSigmaRatio": 0.05,
        "odometryDstSigmaRatio": 0.02,
        "odometryAngSigmaRatio": 0.02,
        "rangeSigmaRatio": 0.01,
    },
}


def no_ear(*_: object) -> None:
    """Hears, and heeds nothing."""


def ratio_that_loses_half() -> float:
    """Nothing but one straight move: P has rank 1, and NEES is (w σ / s σ)² with w of N(0, 1). Half
    of the runs are beyond the 99.9 % quantile of one degree where s is the median of |w| over its
    root.
    """
    return 0.6744897502 / math.sqrt(10.82756617)


def test_the_smallest_ratio_is_that_of_the_closed_form():
    straight = replace(ROOM, commands=(Move(1.0, 0.0),), seed=5)
    with crew(1, Lost(), "quick", no_ear) as judge:
        found = [one for one in needed(straight, judge, 0.5) if one is not None]
    by_key = {(one.told.key, one.told.value > one.true): one for one in found}
    less = by_key["noise.odometryDstSigmaRatio", False]
    assert less.told.value / less.true == pytest.approx(ratio_that_loses_half(), rel=0.05)
    assert less.count.share >= 0.5
    assert ("noise.odometryDstSigmaRatio", True) not in by_key
    assert ("noise.rangeSigmaRatio", False) not in by_key  # there is no reading
    assert len(by_key) == len(found)


def test_a_told_number_is_told_and_the_truth_stays():
    for key, value in (("noise.rangeSigmaRatio", 0.3), ("start.theta", 7.0), ("start.x", 2.25)):
        told = Told(key, value)
        one, other = told.of(ROOM).world, untruly(ROOM, told).world
        assert one.told.noise == other.told.noise
        np.testing.assert_allclose(one.told.start, other.told.start)
        np.testing.assert_array_equal(other.start, ROOM.world.start)
        assert other.noise == ROOM.world.noise
    assert math.degrees(Told("start.theta", 7.0).of(ROOM).world.told.start[2]) == pytest.approx(7)


def test_the_smallest_change_is_written():
    found = hunt(Asked(ROOM, change="told", runs=100, enough=0.2), no_ear, no_ear)
    factors = [one.factor for one in found.needed]
    assert len(factors) > 1
    assert factors == sorted(factors)
    smallest = found.needed[0]
    assert found.scene.world.told.noise == smallest.told.of(ROOM).world.told.noise
    assert found.scene.world.noise == ROOM.world.noise
    assert found.scene.commands == COMMANDS


def test_starts_are_where_a_robot_can_do_as_it_is_asked():
    starts, rng = Starts(ROOM.world, COMMANDS), np.random.default_rng(2)
    low, high = ROOM.world.map.walls.boxes
    low, high = low.min(axis=0), high.max(axis=0)
    for _ in range(40):
        one = starts.by_chance(rng)
        end = np.array([one.x + math.cos(one.theta), one.y + math.sin(one.theta)])
        assert (low < [one.x, one.y]).all()
        assert ([one.x, one.y] < high).all()
        assert (low < end).all()
        assert (end < high).all()
    assert not starts.suits(Started(high[0] - 0.5, 1.5, 0.0))


def test_a_start_is_found_where_the_same_commands_are_lost():
    room = load_scene({"world": "furnished-room", "commands": []})
    listed = (Move(3.1, math.radians(-25)), Move(2.6, math.radians(65)), Sense(1.6))
    asked = Asked(replace(room, commands=listed), change="start", lists=150, runs=200)
    found = hunt(asked, no_ear, no_ear)
    assert found.scene.commands == listed
    assert (found.scene.world.start[:2] != room.world.start[:2]).any()
    np.testing.assert_array_equal(found.scene.world.told.start, found.scene.world.start)
    usual = Lost(0.1)(asked.scene, 0, 200)
    assert found.fresh.share > usual.share


def test_the_budget_ends_it_and_an_interruption_keeps_what_was_found():
    with pytest.raises(RunError, match=r"in the 1e-09 s of --budget"):
        hunt(Asked(ROOM, change="told", seconds=1e-9), no_ear, no_ear)
    heard = 0

    def after_some():
        nonlocal heard
        heard += 1
        if heard > 12:
            raise KeyboardInterrupt

    found = hunt(Asked(ROOM, change="told", runs=100), no_ear, after_some)
    assert found.end == "interrupted"
    assert len(found.needed) >= 1

    def at_once():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hunt(Asked(ROOM, change="told"), no_ear, at_once)


def test_of_a_list_that_no_run_is_lost_in_nothing_is_written():
    with pytest.raises(RunError, match="no run of 128 lists does that"):
        hunt(Asked(ROOM, change="start", lists=128, moves=1, off=50.0), no_ear, no_ear)


def test_no_start_is_beside_a_wall_that_stands_free():
    panel = {"name": "panel", "points": [[2.0, 1.0], [2.0, 3.0]]}
    boundary = [[0, 0], [4, 0], [4, 4], [0, 4]]
    world = {**FIELD, "boundary": boundary, "walls": [panel]}
    starts = Starts(load_world(world), ())
    assert not starts.suits(Started(1.8, 2.0, 0.0))
    assert starts.suits(Started(1.6, 2.0, 0.0))
    assert starts.suits(Started(2.0, 3.5, 0.0))  # beyond its end


def test_a_start_that_is_unknown_is_no_number_to_change():
    world = {**FIELD, "boundary": [[0, 0], [4, 0], [4, 4], [0, 4]], "belief": {"start": "unknown"}}
    scene = replace(ROOM, world=load_world(world), filter="pf")

    def judge(scene, variants, first, runs):
        return [Count(runs, runs) for _ in variants]

    found = [one.told.key for one in needed(scene, judge, 0.5) if one is not None]
    assert found
    assert not [key for key in found if key.startswith("start")]


@pytest.mark.parametrize(("told", "factor"), [(0.005, 2.0), (0.04, 4.0)])
def test_a_change_is_as_large_either_way(told, factor):
    assert Needed(Told("noise.rangeSigmaRatio", told), 0.01, Count(1, 2)).factor == factor


def test_a_map_that_the_filter_is_told_otherwise_loses_no_obstacle():
    """What it is not told of would be lost with it."""
    world = {
        **FIELD,
        "obstacles": [
            {"name": name, "circle": {"x": x, "y": 3, "radius": 0.3}}
            for name, x in (("a", 1), ("b", 3))
        ],
    }
    alike, other = (
        replace(ROOM, world=load_world(one))
        for one in (world, {**world, "belief": {"missing": ["a"]}})
    )
    assert [one.name for one in without(alike, "a").world.told.map.obstacles] == ["b"]
    assert without(other, "b") is None
    assert without(alike, "c") is None


def test_a_start_becomes_rounder_only_where_as_many_runs_do_it():
    """Half of the runs do it, and none where x is below 1.9 or the heading is not as it is."""
    best = Started(1.93, 2.06, math.radians(37))

    def judge(scene, variants, first, runs):
        does = [one.x >= 1.9 and one.theta == best.theta for one in variants]
        return [Count(runs // 2 if yes else 0, runs) for yes in does]

    found, count = rounder(ROOM, Starts(ROOM.world, COMMANDS), best, judge)
    assert (found.x, found.y, found.theta) == (2.0, 2.0, best.theta)
    assert count.share == 0.5
