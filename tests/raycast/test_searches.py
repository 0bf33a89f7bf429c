"""What is particular to each search; that all find the same is told in test_walls.py."""

import subprocess
import sys

import numpy as np
import pytest
from wall_worlds import (
    DESK,
    ROOM,
    WORLDS,
    assert_same,
    beams,
    by_brute_force,
    near_beams,
    stars,
    together,
    town,
)
from ways import WAYS

from ekfsim.raycast.searches.choice import BLOCK
from ekfsim.raycast.searches.few_walls import few_walls
from ekfsim.raycast.searches.flat_grid import BORDER, PLAIN
from ekfsim.raycast.searches.scan import scan
from ekfsim.raycast.walls import Walls
from ekfsim.twins import taking

needs_numba = pytest.mark.skipif(
    "compiled" not in WAYS, reason="numba, the extra `fast`, is not installed"
)


@pytest.mark.parametrize("name", WORLDS)
def test_hardly_a_beam_is_left_in_doubt(name):
    """Else every beam would be followed twice, and the quick ways would be no quicker."""
    walls = Walls.of(WORLDS[name])
    near = x, y, dx, dy, span = near_beams(walls, *beams(1000, seed=3))
    ends = walls.segments.reshape(-1, 4)
    assert len(few_walls(ends, *near)[2]) <= 5
    assert len(scan(ends, x[0], y[0], dx, dy, span[0])[2]) <= 5


@needs_numba
@pytest.mark.parametrize("name", WORLDS)
def test_hardly_a_beam_is_left_in_doubt_by_the_compiled_walk(name):
    from ekfsim.raycast.searches import compiled

    walls = Walls.of(WORLDS[name])
    *found, doubtful = compiled.walk(walls.flat_grid, *near_beams(walls, *beams(1000, seed=3))[:4])
    assert len(doubtful) <= 5
    assert_same(found, by_brute_force(walls, *beams(1000, seed=3)), 1.0, but=doubtful)


@needs_numba
def test_walls_on_each_other_are_no_doubt_to_the_compiled_walk():
    from ekfsim.raycast.searches import compiled

    rings = stars(40, 2)
    walls = Walls.of({**rings, **{f"{name} again": ring for name, ring in rings.items()}})
    near = near_beams(walls, *beams(1000, seed=3))
    assert not len(compiled.walk(walls.flat_grid, *near[:4])[2])


@pytest.mark.parametrize("name", WAYS)
def test_a_beam_in_a_batch_has_the_hit_that_it_has_alone(name):
    """Whatever the batch: how many, from where, and what stands beside it."""
    walls = Walls.of(town("houses", 5, 20.0))
    origin, heading = beams(2 * BLOCK + 70, 6, 490, 530)
    origin[7], heading[BLOCK + 1], origin[2 * BLOCK] = np.nan, np.inf, 1e13
    with taking(name):
        hit = walls.cast(origin, heading)
        for some in (slice(0, 70), slice(BLOCK - 40, BLOCK + 40), slice(2 * BLOCK - 10, None)):
            part = walls.cast(origin[some], heading[some])
            np.testing.assert_allclose(part.range, hit.range[some], rtol=1e-12, atol=1e-9)
            np.testing.assert_array_equal(part.wall, hit.wall[some])
    known = np.delete(np.arange(len(heading)), [7, BLOCK + 1])
    assert_same(
        (hit.range[known], hit.wall[known]),
        by_brute_force(walls, origin[known], heading[known]),
        1e13,
    )
    assert (hit.wall[[7, BLOCK + 1]] == -1).all()
    assert np.isnan(hit.range[[7, BLOCK + 1]]).all()


SCANS = {
    "a full turn": np.linspace(-np.pi, np.pi, 360, endpoint=False),
    "a full turn, both ends": np.linspace(-np.pi, np.pi, 361),
    "three quarters": np.linspace(-2.4, 2.4, 270) + 1.0,
    "clockwise": np.linspace(9.0, 3.0, 200),
    "uneven": np.sort(np.random.default_rng(1).uniform(-20, 20, 300)),
    "in any order": np.random.default_rng(2).uniform(-3, 3, 300),
    "all the same": np.full(100, 0.7),
    "after many turns": np.linspace(0, 6, 300) + 1e9,
    "one": np.array([0.3]),
}


@pytest.mark.parametrize("name", SCANS)
@pytest.mark.parametrize(
    "place", [(5.0, 4.0), (3.0, 2.5), (2.0, 2.0), (4.0, 2.7), (0.0, 0.0), (-3.0, 1.0), (5.0, 2.0)]
)
def test_a_scan_however_its_beams_are_spaced(name, place):
    """From the open, from inside the desk, from a corner, from a wall, from outside, from a wall's
    line."""
    walls = Walls.of({"room": ROOM, "desk": DESK, **stars(8, 4, side=10.0)})
    heading = SCANS[name]
    x, y, dx, dy, span = near_beams(walls, np.tile(place, (len(heading), 1)), heading)
    *found, doubtful = scan(walls.segments.reshape(-1, 4), x[0], y[0], dx, dy, span[0])
    expected = by_brute_force(walls, np.stack([x, y], -1), heading)
    assert_same(found, expected, 1.0, but=doubtful)
    hit = walls.cast(np.array(place), heading)
    assert_same((hit.range, hit.wall), expected, 1.0)


@pytest.mark.parametrize("name", WORLDS)
@pytest.mark.parametrize("spread", [1e-3, 0.1, 2.0])
def test_beams_that_lie_close_together(name, spread):
    """And some that do not; where they spread too far there is no bundle."""
    walls, random = Walls.of(WORLDS[name]), np.random.default_rng(3)
    formed = 0
    for origin, heading in zip(*beams(20, seed=4), strict=True):
        origins = origin + random.normal(0, spread, (200, 2))
        headings = heading + random.normal(0, spread / 20, 200)
        origins[:10] += random.uniform(-50, 50, (10, 2))
        expected = by_brute_force(walls, origins, headings)
        found = together(walls, origins, headings)
        if found is not None:
            formed += 1
            assert_same(found[:2], expected, 1.0, but=found[2])
        hit = walls.cast(origins, headings)
        assert_same((hit.range, hit.wall), expected, 1.0)
    assert formed or name == "stars that overlap" or spread > 1


def test_a_cell_of_a_town_lists_its_walls_or_names_the_grid_that_does():
    cells = Walls.of(town("houses", 5, 10.0)).flat_grid
    assert set(range(1, len(cells.place))) | {PLAIN, BORDER} == set(cells.within.tolist())
    assert np.diff(cells.start).max() <= 64
    assert not np.diff(cells.start)[cells.within != PLAIN].any()


def test_numpy_is_used_unless_numba_is_asked_for():
    program = """
import sys, numpy as np
from ekfsim.raycast.walls import Walls
Walls.of({"room": np.array([[0, 0], [9, 0], [9, 9], [0, 9.0]])}).cast(np.ones((500, 2)), \
np.linspace(0, 6, 500))
print("numba" in sys.modules)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout == "False\n"
