"""Where a robot is put in a plan that does not say so, against shapely's largest circle."""

from typing import Any

import numpy as np
import pytest
import shapely

from ekfsim.files.maps.plan import Circle, Line, Outline, Plan
from ekfsim.files.maps.standing import roomiest
from ekfsim.geometry import Array


def box(left: float, low: float, right: float, high: float) -> Array:
    """The corners of a rectangle, (4, 2) m."""
    return shapely.get_coordinates(shapely.box(left, low, right, high))[:-1]


def crossing(count: int, seed: int) -> tuple[Line, ...]:
    """Lines across 100 m × 100 m, most of which cross each other."""
    ends = np.random.default_rng(seed).uniform(0, 100, (count, 2, 2))
    return tuple(Line("line", points) for points in ends)


def scattered(seed: int) -> Plan:
    """A room that walls, overlapping triangles, one with a hole, and circles stand in."""
    rng = np.random.default_rng(seed)
    triangles = [
        Outline("triangle", at + rng.uniform(-9, 9, (3, 2))) for at in rng.uniform(0, 50, (12, 2))
    ]
    frame = Outline("frame", box(20, 20, 40, 45), (box(21, 21, 39, 44),))
    circles = tuple(Circle("pillar", x, y, 2.0) for x, y in rng.uniform(0, 50, (5, 2)).tolist())
    lines = tuple(Line("wall", rng.uniform(0, 50, (2, 2))) for _ in range(4))
    return Plan("", box(0, 0, 50, 50), (*triangles, frame), lines, circles)


def free_of(plan: Plan) -> Any:
    """Where a robot can stand, by shapely."""
    assert plan.boundary is not None
    solid = [shapely.Polygon(one.points, one.holes) for one in plan.outlines]
    thin = [shapely.LineString(one.points).buffer(1e-6) for one in plan.lines]
    rounds = [shapely.Point(one.x, one.y).buffer(one.radius, 64) for one in plan.circles]
    return shapely.Polygon(plan.boundary).difference(shapely.union_all([*solid, *thin, *rounds]))


@pytest.mark.parametrize("seed", range(8))
def test_most_room_is_that_of_the_largest_circle_that_fits(seed: int) -> None:
    """Told is how far the walls are from the place itself, which is rounded."""
    plan = scattered(seed)
    free = free_of(plan)
    found = roomiest(plan)
    assert found is not None
    (x, y, theta), room = found
    place = shapely.Point(x, y)
    largest = max(
        shapely.maximum_inscribed_circle(part, tolerance=1e-3).length
        for part in shapely.get_parts(free)
    )
    assert theta == 0
    assert free.contains(place)
    assert room == pytest.approx(free.boundary.distance(place), abs=0.01)  # circles have corners
    assert 0.93 * largest < room < 1.01 * largest


def test_hundreds_of_walls_that_all_cross_leave_a_place() -> None:
    lines = crossing(600, seed=1)
    found = roomiest(Plan("", lines=lines))
    assert found is not None
    (x, y, _), room = found
    walls = shapely.multilinestrings([shapely.LineString(line.points) for line in lines])
    assert room <= shapely.distance(walls, shapely.Point(x, y)) + 1e-9
    somewhere = shapely.points(np.random.default_rng(2).uniform(3, 97, (2000, 2)))
    assert room > shapely.distance(walls, somewhere).max()


def test_a_gap_between_what_takes_up_all_else_is_found() -> None:
    below, above = Outline("", box(0, 0, 1000, 617.3)), Outline("", box(0, 617.9, 1000, 1000))
    found = roomiest(Plan("", box(0, 0, 1000, 1000), (below, above)))
    assert found is not None
    (_, y, _), room = found
    assert y == pytest.approx(617.6, abs=0.02)
    assert room == pytest.approx(0.3, abs=0.02)


def test_a_wall_that_reaches_far_out_of_the_room_changes_nothing() -> None:
    far = Line("", np.array([(-1e7, 0.5), (1e7, 0.5)]))
    found = roomiest(Plan("", box(0, 0, 1, 1), lines=(far,)))
    assert found is not None
    assert found[1] == pytest.approx(0.25, abs=0.01)


@pytest.mark.parametrize("solid", [box(0, 0, 9, 9), box(-1, -1, 10, 10)])
def test_where_all_is_taken_a_robot_can_stand_nowhere(solid: Array) -> None:
    assert roomiest(Plan("", box(0, 0, 9, 9), (Outline("", solid),))) is None


@pytest.mark.parametrize(
    "plan", [Plan(""), Plan("", lines=(Line("", np.array([(0.0, 3.0), (8.0, 3.0)])),))]
)
def test_beside_a_single_wall_there_is_room(plan: Plan) -> None:
    found = roomiest(plan)
    assert found is not None
    assert found[1] > 0.4
