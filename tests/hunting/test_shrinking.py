"""Shrinking, where it is known beforehand which lists do it."""

import math
from collections.abc import Sequence

import pytest

from ekfsim.commands import Move, Sense
from ekfsim.files.scenes.load import load_scene
from ekfsim.hunting.changes.lists import CLEAR, Space
from ekfsim.hunting.changes.variants import Commanded
from ekfsim.hunting.goals import Count
from ekfsim.hunting.search import Seen
from ekfsim.hunting.shrinking import RUNS, shrunk
from ekfsim.hunting.worlds import without

ROOM = load_scene({"world": "furnished-room", "commands": []})
SPACE = Space(ROOM.world, 8)
NEEDED = Sense(math.radians(37))
LISTED = (Sense(0.0), Move(0.35, math.radians(17)), NEEDED, Sense(math.radians(-90)))


def planned(share):
    """A judge that knows the share of runs of every list."""

    def judge(scene, variants, first: int, runs: int) -> Sequence[Count]:
        assert (first, runs) == (0, RUNS)
        return [Count(round(RUNS * share(scene, one.commands)), RUNS) for one in variants]

    return judge


def less(share, least, listed=LISTED, barred=lambda scene, name: None):
    return shrunk(ROOM, SPACE, listed, planned(share), least, barred, lambda: True)


@pytest.mark.parametrize("least", [None, 0.3])
def test_only_what_is_needed_is_left(least):
    """Half of the runs with it, none without: nothing else is left, and of that no number."""
    found = less(lambda _, listed: 0.5 if NEEDED in listed else 0.0, least)
    assert found.listed == (NEEDED,)
    assert found.count == Count(RUNS // 2, RUNS)


@pytest.mark.parametrize(
    ("least", "of_fewer", "whole"),
    [
        (None, 0.55, True), (None, 0.58, False),  # of 0.6 the interval begins at 0.57
        (0.4, 0.42, True), (0.4, 0.44, False),  # surely above 0.4: the interval of 0.44 is
    ],
)  # fmt: skip
def test_a_share_that_may_be_less_than_is_wanted_is_not_enough(least, of_fewer, whole):
    found = less(lambda _, listed: 0.6 if len(listed) == len(LISTED) else of_fewer, least)
    assert (len(found.listed) == len(LISTED)) == whole


def test_numbers_become_as_round_as_they_may():
    """While the list is as long: nothing of a move but that it turns by more than a third."""

    def share(_, listed):
        turned = any(isinstance(one, Move) and one.angle > math.radians(40) for one in listed)
        return 0.6 if turned else 0.0

    found = less(share, None, (Move(0.35, math.radians(47)), Sense(0.3)))
    assert found.listed == (Move(0.0, math.radians(90)),)


def test_a_rounder_way_does_not_lead_into_a_wall():
    free, _ = ROOM.world.map.walls.first(*ROOM.world.start)
    far = math.floor(20 * (free - CLEAR)) / 20
    assert round(far) > far  # the next whole metre is behind the wall
    found = less(lambda _, listed: 0.6 if listed[0].distance >= far - 0.02 else 0.0, None,
                 (Move(far, 0.0),))  # fmt: skip
    assert found.listed == (Move(far, 0.0),)
    assert SPACE.mended(found.listed) == found.listed


def test_obstacles_go_but_for_the_one_that_is_needed():
    desk = ROOM.world.map.obstacles[0].name

    def share(scene, listed):
        return 0.6 if desk in [one.name for one in scene.world.map.obstacles] else 0.0

    found = less(share, None, barred=without)
    assert [one.name for one in found.scene.world.map.obstacles] == [desk]
    assert [one.name for one in found.scene.world.told.map.obstacles] == [desk]


def test_nothing_is_left_out_that_keeps_the_robot_from_a_wall():
    """Two half turns: without either alone the way would lead through the wall behind."""
    half = Move(0.0, math.pi)
    listed = (half, half, Move(3.0, 0.0))
    assert SPACE.mended(listed) == listed
    assert SPACE.mended(listed[1:]) != listed[1:]
    found = less(lambda _, some: 0.6 if some[-1] == listed[-1] else 0.0, None, listed)
    assert found.listed == listed


def test_of_lists_that_do_as_much_the_shorter_is_better():
    one, two, better = (
        Seen(Commanded(listed), Count(hits, 10))
        for listed, hits in (((NEEDED,), 5), ((NEEDED, NEEDED), 5), ((NEEDED, NEEDED), 6))
    )
    assert better.rank > one.rank > two.rank
