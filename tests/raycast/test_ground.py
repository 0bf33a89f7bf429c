"""Where a robot can stand, held against Shapely."""

import numpy as np
import pytest
import shapely
from wall_worlds import WORLDS

from ekfsim.raycast.ground import CLEARANCE
from ekfsim.raycast.walls import BOUNDARY, Walls
from ekfsim.twins import taking

ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
DESK = np.array([[4, 3], [5, 3], [5, 4], [4, 4.0]])
CROSSING = np.array([[9, 2], [12, 2], [12, 3], [9, 3.0]])  # the room's own wall runs through it
OVERLAPPING = np.array([[4.5, 3.5], [6, 3.5], [6, 5], [4.5, 5.0]])  # lies over a corner of the desk
# touches the room's wall, and turns the other way round
SHELF = np.array([[0, 6], [0, 7], [0.4, 7], [0.4, 6.0]])
RINGS = {
    BOUNDARY: ROOM,
    "desk": DESK,
    "crossing": CROSSING,
    "overlapping": OVERLAPPING,
    "shelf": SHELF,
}
PLACES = {
    "room": RINGS,
    "no boundary": {name: ring for name, ring in RINGS.items() if name != BOUNDARY},
    "far away": {name: np.add(ring, (4e5, 5e6)) for name, ring in RINGS.items()},
    "empty": {},
    **{name: rings for name, rings in WORLDS.items() if sum(map(len, rings.values())) < 500},
}


def free(rings, points):
    """Whether Shapely has points (…, 2) in the room and in no obstacle."""
    x, y = points[..., 0], points[..., 1]
    inside = [
        shapely.contains_xy(shapely.Polygon(ring), x, y)
        for name, ring in rings.items()
        if name != BOUNDARY
    ]
    indoors = (
        shapely.contains_xy(shapely.Polygon(rings[BOUNDARY]), x, y)
        if BOUNDARY in rings
        else np.full(x.shape, True)
    )
    return indoors & ~np.any([*inside, np.zeros(x.shape, bool)], axis=0)


def thrown(rings, n, seed=0):
    """Points about a world."""
    points = np.concatenate([np.zeros((1, 2)), *rings.values()])[1 if rings else 0 :]
    low, high = points.min(axis=0) - 1, points.max(axis=0) + 1
    return np.random.default_rng(seed).uniform(low, high, (n, 2))


@pytest.mark.parametrize("name", PLACES)
def test_it_is_free_where_shapely_says_so(name):
    rings = PLACES[name]
    points = thrown(rings, 3000)
    assert (Walls.of(rings).ground.free(points) == free(rings, points)).all()


@pytest.mark.parametrize(
    "name", ["room", "no boundary", "far away", "empty", "in a room", "a tangle"]
)
def test_one_robot_is_told_the_same_as_many(name):
    """By the twin for one place, as by the text."""
    ground = Walls.of(PLACES[name]).ground
    places = thrown(PLACES[name], 30)
    for place, ways in zip(
        places, thrown(PLACES[name], 180, seed=2).reshape(-1, 6, 2) - places[:, None], strict=True
    ):
        with taking("plain"):
            expected = ground.reach(place, ways)
        assert ground.reach(place, ways) == pytest.approx(expected, abs=1e-12)
        assert ground.reach(place[None], ways[:1]) == pytest.approx(expected[:1], abs=1e-12)


@pytest.mark.parametrize("name", ["room", "no boundary", "far away"])
def test_a_way_is_cut_back_to_the_last_place_where_a_robot_can_stand(name):
    """Tried along the whole way in steps of a thousandth."""
    rings = PLACES[name]
    place, ends = thrown(rings, 400), thrown(rings, 400, seed=1)
    way = ends - place
    share = Walls.of(rings).ground.reach(place, way)
    steps = np.linspace(0, 1, 1001)
    along = free(rings, place[:, None] + steps[:, None] * way[:, None])
    last = np.where(
        along.any(axis=1), steps[along.shape[1] - 1 - along[:, ::-1].argmax(axis=1)], 0.0
    )
    assert ((share == 1) == free(rings, ends)).all()
    assert (share - last <= 1e-3 + 1e-12).all()
    assert (last - share <= CLEARANCE / np.linalg.norm(way, axis=1) + 1e-12).all()
    asked = share > 0
    assert asked.sum() > 100
    assert (~asked).any()
    assert free(rings, (place + share[:, None] * way)[asked]).all()


def test_a_gap_narrower_than_the_clearance_is_stood_in_its_middle():
    walls = Walls.of({"west": np.subtract(ROOM, (10, 0)), "east": np.add(ROOM, (1e-4, 0))})
    share = walls.ground.reach(np.array([-5.0, 4.0]), np.array([10.0, 0.0]))
    assert 10 * share - 5 == pytest.approx(5e-5)


def test_a_way_along_an_edge_or_through_a_corner_ends_in_the_open():
    walls = Walls.of({BOUNDARY: ROOM, "desk": DESK})
    for place, end in (
        ((2, 3), (4.5, 3)),
        ((2, 4), (4.5, 4)),
        ((3, 2), (4.5, 3.5)),
        ((4, 1), (4, 3.5)),
    ):
        place, way = np.array(place, float), np.subtract(end, place)
        share = float(walls.ground.reach(place, way))
        assert share > 0.5
        assert not shapely.contains_xy(shapely.Polygon(DESK), *(place + share * way))


def test_no_number_is_no_place():
    ground = Walls.of({BOUNDARY: ROOM}).ground
    assert ground.free(np.array([[np.nan, 1.0], [1.0, 1.0], [np.inf, 1.0]])).tolist() == [
        False,
        True,
        False,
    ]
    for floor in (ground, Walls.of({"desk": DESK}).ground):
        assert floor.reach(np.array([np.nan, 1.0]), np.ones((1, 2))).tolist() == [0.0]
