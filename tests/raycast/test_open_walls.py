"""Lines of walls that stay open, among polygons and by themselves."""

import math

import numpy as np
import pytest
from wall_worlds import (
    DESK,
    NONE,
    ROOM,
    assert_all_searches_agree,
    beams,
    by_shapely,
    in_every_way,
    stars,
)

from ekfsim.raycast.walls import Walls

HOOK = np.array([[7.0, 0], [7, 5], [9, 5]])


def strokes(count, seed, side=100.0):
    """Lines of two to five points all over the map, across one another and often themselves."""
    random = np.random.default_rng(seed)
    return {
        f"stroke {i}": random.uniform(0, side, 2)
        + np.cumsum(random.normal(0, side / 12, (random.integers(2, 6), 2)), axis=0)
        for i in range(count)
    }


@pytest.mark.parametrize("rings", [{}, stars(40, 3)], ids=["alone", "among stars"])
def test_ranges_are_those_of_shapely(rings):
    walls = Walls.of(rings, strokes(60, 4))
    origin, heading = beams(1000, seed=9)
    ranges = assert_all_searches_agree(walls, origin, heading)
    np.testing.assert_allclose(ranges, by_shapely(walls, origin, heading, 500), rtol=0, atol=1e-9)


def test_a_line_stays_open_and_its_edges_follow_those_of_the_polygons():
    walls = Walls.of({"boundary": ROOM, "desk": DESK}, {"hook": HOOK})
    assert [walls.name(wall) for wall in range(8, 10)] == [("hook", 0), ("hook", 1)]
    np.testing.assert_array_equal(walls.segments[8:], [[[7, 0], [7, 5]], [[7, 5], [9, 5]]])
    assert len(walls.segments) == 10


def test_a_line_that_ends_where_it_begins_is_closed_by_its_own_last_edge():
    loop = np.array([[1.0, 1], [2, 1], [2, 2], [1, 1]])
    walls = Walls.of({}, {"loop": loop})
    np.testing.assert_array_equal(walls.segments, np.stack([loop[:-1], loop[1:]], 1))
    assert walls.ground.free(np.array([1.7, 1.3]))  # it has no inside


@in_every_way
def test_beams_pass_where_a_ring_would_close_and_through_a_gap():
    walls = Walls.of({}, {"hook": HOOK, "left": [[0, 6], [4, 6]], "right": [[4.5, 6], [9, 6]]})
    assert walls.first(6.0, 3.0, math.pi / 4) == pytest.approx((math.sqrt(2), 0))
    assert walls.first(8.0, 0.5, math.pi) == pytest.approx((1.0, 0))
    assert walls.first(8.5, 4.9, -math.pi / 2) == NONE  # no edge from [9, 5] back to [7, 0]
    assert walls.first(4.25, 0.0, math.pi / 2) == NONE
    assert walls.first(4.0, 0.0, math.pi / 2) == pytest.approx((6.0, 2))  # an end is hit


@in_every_way
@pytest.mark.parametrize("heading", [math.atan2(5, 4), math.atan2(-4, -1), math.atan2(-3, 4)])
def test_nothing_slips_between_lines_that_meet_in_a_corner(heading):
    corner = np.array([7.0, 5.0])
    walls = Walls.of({}, {"up": [[7, 0], corner], "across": [corner, [9, 5]]})
    for length in (1.0, 3.0, 7.0):
        x, y = corner - length * np.array([math.cos(heading), math.sin(heading)])
        assert walls.first(x, y, heading)[0] == pytest.approx(length, abs=1e-12)


@in_every_way
def test_a_beam_along_a_line_meets_its_nearer_end_and_from_the_line_nothing_is_far():
    walls = Walls.of({}, {"wall": [[2, 1], [4, 1]]})
    assert walls.first(1.0, 1.0, 0.0) == pytest.approx((1.0, 0))
    assert walls.first(6.0, 1.0, math.pi) == pytest.approx((2.0, 0))
    assert walls.first(3.0, 1.0, math.pi / 2) == (0.0, 0)


def test_edges_of_one_line_in_one_direction_are_one_wall():
    walls = Walls.of({}, {"a": [[0, 0], [1, 0], [2, 0], [2, 3]], "b": [[2, 0], [4, 0]]})
    assert walls.line.tolist() == [0, 0, 1, 2]


def test_a_robot_can_stand_on_both_sides_but_not_in_an_obstacle():
    walls = Walls.of({"boundary": ROOM, "desk": DESK}, {"hook": HOOK})
    places = np.array([[6.9, 2], [7.1, 2], [3, 2.5], [11, 2]])
    assert walls.ground.free(places).tolist() == [True, True, False, False]
