import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from wall_worlds import (
    DESK,
    NONE,
    ROOM,
    SCENE,
    WORLDS,
    assert_all_searches_agree,
    beams,
    by_shapely,
    in_every_way,
    stars,
    tangle,
    town,
)

from ekfsim.raycast.walls import Walls


@pytest.mark.parametrize("name", WORLDS)
def test_ranges_are_those_of_shapely(name):
    walls = Walls.of(WORLDS[name])
    origin, heading = beams(1000, seed=9)
    ranges = assert_all_searches_agree(walls, origin, heading)
    np.testing.assert_allclose(ranges, by_shapely(walls, origin, heading, 500), rtol=0, atol=1e-9)


@pytest.mark.parametrize("size", [0.03, 1.0, 1e5])
@pytest.mark.parametrize("shift", [0.0, 1.0, 100.0])
def test_scale_and_place_of_the_world_do_not_matter(size, shift):
    rings = {name: ring / 100 * size + shift * size for name, ring in stars(80, 2).items()}
    walls = Walls.of(rings)
    origin, heading = beams(300, seed=3)
    origin = origin / 100 * size + shift * size
    ranges = assert_all_searches_agree(walls, origin, heading, max(1.0, size * shift))
    np.testing.assert_allclose(
        ranges, by_shapely(walls, origin, heading, 5 * size), atol=1e-9 * max(1, size * shift)
    )


@pytest.mark.parametrize("distance", [1e3, 1e9, 1e13, 1e16])
def test_from_afar_too_all_searches_agree(distance):
    """From 1e13 m a coordinate's last place is finer than a wall; from 1e16 m it is coarser than
    many a cell."""
    random = np.random.default_rng(2)
    bearing = random.uniform(-np.pi, np.pi, 200)
    origin = random.uniform(0, 100, (200, 2)) + distance * np.stack(
        [np.cos(bearing), np.sin(bearing)], -1
    )
    ranges = assert_all_searches_agree(Walls.of(stars(800, 3)), origin, bearing + np.pi, distance)
    assert np.isfinite(ranges).any()


@given(st.integers(1, 40), st.integers(0, 10**6), st.sampled_from([stars, tangle]))
@settings(max_examples=40, deadline=None)
def test_any_world_is_cast_alike_by_all_searches(count, seed, world):
    walls = Walls.of(world(count, seed))
    origin, heading = beams(80, seed)
    ranges = assert_all_searches_agree(walls, origin, heading)
    np.testing.assert_allclose(ranges, by_shapely(walls, origin, heading, 500), rtol=0, atol=1e-9)


@given(st.integers(0, 10**6), st.integers(1, 12))
@settings(max_examples=40, deadline=None)
def test_a_lattice_full_of_ties_is_cast_alike_by_all_searches(seed, count):
    """Squares that share corners and edges; origins on them; beams along them, through corners, by
    fours of a turn."""
    random = np.random.default_rng(seed)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    walls = Walls.of(
        {str(i): square * random.integers(1, 4) + random.integers(0, 6, 2) for i in range(count)}
    )
    origin = random.integers(-4, 20, (120, 2)) / 2
    heading = random.integers(-8, 9, 120) * np.pi / 4
    assert_all_searches_agree(walls, origin, heading)


@given(st.integers(0, 10**6), st.floats(-np.pi, np.pi), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
@settings(max_examples=60, deadline=None)
def test_robot_and_world_moved_together_change_no_range(seed, angle, east, north):
    rings = stars(20, seed)
    origin, heading = beams(50, seed)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    moved = {name: ring @ turn.T + [east, north] for name, ring in rings.items()}
    before = Walls.of(rings).cast(origin, heading)
    after = Walls.of(moved).cast(origin @ turn.T + [east, north], heading + angle)
    np.testing.assert_allclose(after.range, before.range, atol=1e-8)
    np.testing.assert_array_equal(after.wall, before.wall)


@in_every_way
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_nan_is_no_echo(bad):
    for beam in ((bad, 1.0, 0.0), (1.0, bad, 0.0), (1.0, 1.0, bad)):
        assert SCENE.first(*beam) == NONE
    many = SCENE.cast(np.ones((300, 2)), np.where(np.arange(300) == 7, bad, 0.0))
    assert np.flatnonzero(np.isnan(many.range)).tolist() == [7]
    assert many.wall[7] == -1


@in_every_way
def test_no_walls_no_hits():
    empty = Walls.of({})
    assert empty.first(0, 0, 0) == NONE
    hit = empty.cast(np.zeros((200, 2)), np.zeros(200))
    assert np.isnan(hit.range).all()
    assert (hit.wall == -1).all()
    assert empty.segments.shape == (0, 2, 2)
    assert empty.line.shape == (0,)


@in_every_way
@pytest.mark.parametrize(
    ("origin", "heading", "shape"),
    [
        ((2,), (), ()),
        ((2,), (5,), (5,)),
        ((3, 1, 2), (4,), (3, 4)),
        ((0, 2), (0,), (0,)),
        ((20, 1, 2), (30,), (20, 30)),
    ],
)
def test_origins_and_headings_broadcast(origin, heading, shape):
    o, h = np.full(origin, 1.0), np.linspace(0, 3, math.prod(heading)).reshape(heading)
    hit = SCENE.cast(o, h)
    assert hit.range.shape == hit.wall.shape == shape
    assert hit.range.dtype == np.float64
    assert hit.wall.dtype == np.int64
    np.testing.assert_allclose(
        hit.range, np.broadcast_to(SCENE.cast(np.ones(2), h).range, shape), rtol=1e-12
    )


def test_edges_are_numbered_as_in_the_file():
    doubled = np.array([[0, 0], [4, 0], [4, 0], [4, 4], [0, 4], [0, 0.0]])
    walls = Walls.of(
        {"room": doubled, "point": np.ones((1, 2)), "nothing": np.empty((0, 2)), "desk": DESK}
    )
    assert walls.edge.tolist() == [0, 2, 3, 4, 0, 1, 2, 3]
    assert walls.polygon.tolist() == [0] * 4 + [3] * 4
    assert walls.name(3) == ("room", 4)
    assert walls.name(6) == ("desk", 2)


def test_normals_point_to_the_left():
    np.testing.assert_allclose(SCENE.normals[:4], [[0, 1], [-1, 0], [0, -1], [1, 0]], atol=0)
    walls = Walls.of(stars(20, 3))
    way = walls.segments[:, 1] - walls.segments[:, 0]
    assert (way[:, 0] * walls.normals[:, 1] - way[:, 1] * walls.normals[:, 0] > 0).all()
    np.testing.assert_allclose(np.hypot(*walls.normals.T), 1)
    np.testing.assert_allclose(np.vecdot(way, walls.normals), 0, atol=1e-12)


@given(st.floats(-np.pi, np.pi), st.floats(-1e4, 1e4))
def test_edges_on_one_straight_line_share_its_number(angle, shift):
    """A comb: its teeth end on one line, its gaps on another; the long side is cut in two by a
    point."""
    comb = np.array([[0, 0], [3, 0], [6, 0], [6, 2], [4, 2], [4, 1], [2, 1], [2, 2], [0, 2.0]])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    walls = Walls.of({"comb": comb @ turn.T + shift, "again": comb @ turn.T + shift})
    assert walls.line.tolist() == [0, 0, 1, 2, 3, 4, 5, 2, 6, 7, 7, 8, 9, 10, 11, 12, 9, 13]


def test_long_diagonals_do_not_fill_the_grid():
    diagonal = np.array([[0, 0], [100, 100], [100, 100.1], [0, 0.1]])
    grid = Walls.of({"diagonal": diagonal, **stars(2000, 1)}).grid
    assert len(grid.walls) < 4 * len(grid.segments)


def test_a_tangle_of_long_walls_stays_within_memory():
    grid = Walls.of(tangle(2000, 1)).grid
    assert len(grid.walls) < 20 * len(grid.segments)


@pytest.mark.parametrize("width", [20.0, 0.5])
@pytest.mark.parametrize("kind", ["houses", "lattice", "fan"])
def test_a_town_in_a_wide_plain_is_cast_alike_by_all_searches(kind, width):
    rings = town(kind, 5, width)
    walls = Walls.of(rings)
    random = np.random.default_rng(7)
    inside = beams(300, 6, 500 - width / 10, 500 + 1.1 * width)
    outside = beams(200, 8, 0, 1000)
    aim = 500 + random.uniform(0, width, (200, 2)) - outside[0]
    for origin, heading in (inside, outside, (outside[0], np.arctan2(*aim.T[::-1]))):
        assert_all_searches_agree(walls, origin, heading, scale=1000)
    corners = np.concatenate(list(rings.values()))[random.integers(0, len(rings), 200)]
    to_corners = corners - inside[0][:200]
    assert_all_searches_agree(walls, inside[0][:200], np.arctan2(*to_corners.T[::-1]), scale=1000)
    assert_all_searches_agree(walls, corners, inside[1][:200], scale=1000)


def test_a_town_in_a_wide_plain_is_no_crowd_in_one_cell():
    grid = Walls.of(town("houses", 5, 10.0)).grid

    def fullest(grid):
        *_, cells = grid.plain
        here = max(len(cell) for cell in cells if cell is not None)
        return max([here, *map(fullest, grid.crowded.values())])

    assert grid.crowded
    assert fullest(grid) <= 64


def test_a_hundred_times_the_same_wall_in_a_wide_plain_is_one_place():
    dot = 500 + 1e-6 * np.array([[0, 0], [1, 0], [0, 1.0]])
    walls = Walls.of({"plain": 1000 * ROOM / 10, **{str(i): dot for i in range(100)}})
    origin, heading = np.tile([[499.0, 500.0]], (50, 1)), np.linspace(-2e-6, 4e-6, 50)
    assert_all_searches_agree(walls, origin, heading, scale=1000)
    assert walls.grid.horizon > 2000
