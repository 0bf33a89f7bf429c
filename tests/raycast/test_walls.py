import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from wall_worlds import (
    DESK,
    ROOM,
    WORLDS,
    assert_all_searches_agree,
    beams,
    by_shapely,
    one_by_one,
    stars,
    tangle,
    town,
)
from ways import WAYS

from ekfsim.raycast.rules import REACH
from ekfsim.raycast.walls import Walls
from ekfsim.twins import taking

SCENE = Walls.of({"boundary": ROOM, "desk": DESK})  # walls 0–3 and 4–7: south, east, north, west
NONE = (pytest.approx(math.nan, nan_ok=True), -1)


@pytest.fixture(params=["plain", *WAYS])
def way(request):
    """The text by itself, and what may stand in for it."""
    with taking(request.param):
        yield


in_every_way = pytest.mark.usefixtures("way")


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
@pytest.mark.parametrize(
    ("x", "y", "heading", "r", "wall"),
    [
        (1, 1, 0, 9, 1),
        (1, 1, np.pi / 2, 7, 2),
        (1, 1, np.pi, 1, 3),
        (1, 1, -np.pi / 2, 1, 0),
        (1, 2.5, 0, 1, 7),
        (3, 2.5, 0, 1, 5),  # from inside the desk: its inner side
        (12, 4, np.pi, 2, 1),  # from outside the room: the boundary's outer side
        (-3, 2.5, 0, 3, 3),
        (1e6, 4, np.pi, 1e6 - 10, 1),  # from far outside the grid
        (1e12, 4, np.pi, 1e12 - 10, 1),  # from where rounding is more than a cell
    ],
)
def test_the_first_wall_from_either_side(x, y, heading, r, wall):
    assert SCENE.first(x, y, heading) == (pytest.approx(r, rel=1e-12), wall)


@in_every_way
@pytest.mark.parametrize(
    ("x", "y", "heading"), [(12, 4, 0), (-1, -1, -2), (5, 20, np.pi / 2), (12, 20, 3), (1e12, 4, 0)]
)
def test_a_beam_that_leaves_the_world_meets_nothing(x, y, heading):
    assert SCENE.first(x, y, heading) == NONE


@in_every_way
@pytest.mark.parametrize("turns", range(7, 360, 7))
def test_a_beam_through_a_corner_hits_it_and_takes_the_lower_wall(turns):
    """From all round: into the corner, past its side, and with the float noise of the aim."""
    angle = math.radians(turns)
    x, y = 2 + 0.9 * math.cos(angle), 2 + 0.9 * math.sin(angle)
    r, wall = SCENE.first(x, y, math.atan2(2 - y, 2 - x))
    assert (r, wall) == (pytest.approx(0.9, abs=1e-12), 4)


@in_every_way
def test_nothing_slips_out_between_two_walls():
    random = np.random.default_rng(4)
    ring = stars(1, 5, corners=40)["star 0"]
    origin = ring.mean(0) + random.uniform(-5, 5, (200, 2))
    corner = np.arange(200) % len(ring)
    target = ring[corner]
    heading = np.arctan2(*(target - origin).T[::-1])
    hit = Walls.of({"star": ring}).cast(origin, heading)
    assert (hit.wall >= 0).all()
    assert (hit.range <= np.hypot(*(target - origin).T) + 1e-12).all()


@in_every_way
@pytest.mark.parametrize(("x", "heading", "r"), [(1, 0, 1), (5, np.pi, 1), (-7, 0, 9)])
def test_a_beam_along_a_wall_from_outside_meets_its_near_end(x, heading, r):
    desk = Walls.of({"desk": DESK})
    assert desk.first(x, 2.0, heading) == (pytest.approx(r, abs=1e-12), 0)


@in_every_way
def test_a_beam_along_the_boundary_from_inside_meets_the_wall_it_lies_on():
    assert SCENE.first(3.0, 0.0, 0.0) == (0.0, 0)


@in_every_way
@pytest.mark.parametrize("share", [0.0, 0.1, 1 / 3, 0.5, 0.77, 1.0])
@pytest.mark.parametrize("heading", np.linspace(-np.pi, np.pi, 17))
def test_a_beam_that_starts_on_a_wall_has_range_0(share, heading):
    walls = Walls.of({"slanted": np.array([[0.1, 0.3], [7.7, 2.9], [1.3, 9.1]])})
    for wall, (a, b) in enumerate(walls.segments):
        x, y = a + share * (b - a)
        lowest = wall if 0 < share < 1 else min(wall, (wall + (1 if share else -1)) % 3)
        assert walls.first(x, y, heading) == (0.0, lowest)
        along = math.atan2(*(b - a)[::-1])
        assert walls.first(x, y, along) == (0.0, lowest)


@in_every_way
def test_edges_that_lie_on_each_other_give_the_lowest_wall():
    rng = np.random.default_rng(6)
    left, right = np.array([[0, 0], [3, 1], [2, 4.0]]), np.array([[3, 1], [2, 4], [7, 7.0]])
    for rings, wall in (({"l": left, "r": right}, 1), ({"r": right, "l": left}, 0)):
        walls = Walls.of(rings)
        target = [3, 1] + rng.uniform(0.05, 0.95, (50, 1)) * np.array([-1, 3])
        for origin in (np.array([1.8, 1.4]), np.array([4.0, 4.2])):
            heading = np.arctan2(*(target - origin).T[::-1])
            assert (walls.cast(origin, heading).wall == wall).all()
            assert (one_by_one(walls, np.broadcast_to(origin, (50, 2)), heading)[1] == wall).all()


@in_every_way
def test_a_hair_beside_a_corner_is_beside_it():
    """The tolerance is some units in the last place, not more."""
    walls = Walls.of({"desk": DESK})
    hair = 100 * REACH * 8
    assert walls.first(0.0, 2 - hair, 0.0) == NONE
    assert walls.first(0.0, 2 + hair, 0.0) == (2.0, 3)


@in_every_way
def test_axis_parallel_beams_though_the_cosine_is_not_quite_0():
    assert math.cos(np.pi / 2) != 0
    assert SCENE.first(5.0, 1.0, np.pi / 2) == (pytest.approx(7, abs=1e-12), 2)
    assert SCENE.first(4.0, 0.5, np.pi / 2) == (pytest.approx(1.5, abs=1e-12), 4)
    assert SCENE.first(4.0, 7.0, -np.pi / 2) == (pytest.approx(4, abs=1e-12), 5)


@in_every_way
def test_one_wall_of_a_map_without_height():
    flat = Walls.of({"fence": np.array([[0, 1], [5, 1.0]])})
    assert len(flat.segments) == 2  # there and back
    assert flat.first(2, 0, np.pi / 2) == (pytest.approx(1), 0)
    assert flat.first(-2, 1, 0) == (pytest.approx(2), 0)
    assert flat.first(2, 0, -np.pi / 2) == NONE


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
