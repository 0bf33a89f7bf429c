"""What it means that a beam meets a wall, by the text and by all that may stand in for it."""

import math

import numpy as np
import pytest
from wall_worlds import DESK, NONE, SCENE, in_every_way, one_by_one, stars

from ekfsim.raycast.rules import REACH
from ekfsim.raycast.walls import Walls


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
