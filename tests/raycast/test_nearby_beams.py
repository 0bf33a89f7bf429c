"""Beams that lie close together meet the walls that all others do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from wall_worlds import assert_same, by_brute_force, stars, tangle, together

from ekfsim.raycast.walls import Walls

WORLDS = [Walls.of(rings) for rings in (stars(80, 2), stars(400, 3), tangle(60, 7))]
BEAMS = 300


def close_beams(seed, spread, turn, lone=0):
    """Beams from about one place in about one direction, and a few from elsewhere."""
    random = np.random.default_rng(seed)
    origin = random.uniform(5, 95, 2) + spread * random.normal(size=(BEAMS, 2))
    heading = random.uniform(-np.pi, np.pi) + turn * random.normal(size=BEAMS)
    origin[:lone], heading[:lone] = (
        random.uniform(0, 100, (lone, 2)),
        random.uniform(-np.pi, np.pi, lone),
    )
    return origin, heading


@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from(range(len(WORLDS))),
    st.sampled_from([0.0, 1e-3, 0.3, 2.0]),
    st.sampled_from([0.0, 1e-3, 0.03, 0.15]),
    st.sampled_from([0, 20]),
)
def test_beams_together_meet_the_walls_that_each_meets(seed, world, spread, turn, lone):
    origin, heading = close_beams(seed, spread, turn, lone)
    expected = by_brute_force(WORLDS[world], origin, heading)
    found = together(WORLDS[world], origin, heading)
    if found is not None:
        *found, doubtful = found
        assert_same(found, expected, 100.0, but=doubtful)
    hit = WORLDS[world].cast(origin, heading)
    assert_same((hit.range, hit.wall), expected, 100.0)


def test_close_beams_are_followed_together_and_others_are_not():
    for walls in WORLDS:
        for seed in range(20):
            assert together(walls, *close_beams(seed, 0.1, 0.02)) is not None
            *_, doubtful = together(walls, *close_beams(seed, 0.1, 0.02, lone=20))
            assert 10 < len(doubtful) < 60
            assert together(walls, *close_beams(seed, 0.1, 1.0)) is None
            assert together(walls, *close_beams(seed, 30.0, 0.02)) is None


@pytest.mark.parametrize("gap", [1e-3, 1e-7, 1e-12])
def test_a_corner_before_many_beams_is_met_as_by_each(gap):
    """Two pillars with a gap between them, a wall behind, and beams at the gap from half a metre to
    both sides."""
    pillars = {
        "left": np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]),
        "right": np.array([[1 + gap, 0], [2, 0], [2, 1], [1 + gap, 1.0]]),
        "behind": np.array([[-9, 3], [9, 3], [9, 4], [-9, 4.0]]),
        **{f"post {i}": np.array([[20 + i, 0], [20.5 + i, 0], [20.5 + i, 0.5]]) for i in range(20)},
    }
    walls = Walls.of(pillars)
    x = np.concatenate([np.linspace(0.5, 1.5, BEAMS - 3), [1.0, 1 + gap / 2, 1 + gap]])
    origin, heading = np.stack([x, np.full_like(x, -2.0)], -1), np.full_like(x, np.pi / 2)
    expected = by_brute_force(walls, origin, heading)
    *found, doubtful = together(walls, origin, heading)
    assert_same(found, expected, 20.0, but=doubtful)
    hit = walls.cast(origin, heading)
    assert_same((hit.range, hit.wall), expected, 20.0)


def test_walls_near_a_box():
    walls = Walls.of({"desk": np.array([[2, 2], [4, 2], [4, 3], [2, 3.0]])})
    assert walls.near(np.array([0.0, 0.0]), np.array([1.9, 9.0])).tolist() == []
    assert walls.near(np.array([0.0, 0.0]), np.array([2.0, 9.0])).tolist() == [0, 2, 3]
    assert walls.near(np.array([3.0, 2.4]), np.array([3.1, 2.6])).tolist() == []
    assert Walls.of({}).near(np.zeros(2), np.ones(2)).tolist() == []
