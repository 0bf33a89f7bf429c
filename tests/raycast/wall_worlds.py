"""Worlds of walls, beams to follow in them, and the searches for their walls held against brute
force."""

import math

import numpy as np
import pytest
import shapely
from ways import WAYS

from ekfsim.raycast.brute import brute_force
from ekfsim.raycast.searches.few_walls import few_walls
from ekfsim.raycast.searches.many_beams import many_beams
from ekfsim.raycast.searches.nearby_beams import nearby_beams
from ekfsim.raycast.searches.scan import scan
from ekfsim.raycast.walls import Walls
from ekfsim.twins import taking

ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
DESK = np.array([[2, 2], [4, 2], [4, 3], [2, 3.0]])
SCENE = Walls.of({"boundary": ROOM, "desk": DESK})  # walls 0–3 and 4–7: south, east, north, west
NONE = (pytest.approx(math.nan, nan_ok=True), -1)  # a beam that meets no wall

in_every_way = pytest.mark.usefixtures("way")  # see conftest.py


def stars(count, seed, side=100.0, corners=5, overlap=1.0):
    """Star-shaped polygons, one in each cell of a lattice."""
    random, lattice = np.random.default_rng(seed), math.ceil(math.sqrt(count))
    pitch = side / lattice
    rings = {}
    for place in random.permutation(lattice**2)[:count]:
        angle = (np.arange(corners) + random.uniform(0.1, 0.9, corners)) * 2 * np.pi / corners
        radius = overlap * pitch * random.uniform(0.2, 0.42, (corners, 1))
        centre = (np.array(divmod(place, lattice)) + 0.5) * pitch
        rings[f"star {place}"] = centre + radius * np.stack([np.cos(angle), np.sin(angle)], -1)
    return rings


def tangle(count, seed, side=100.0):
    """Triangles all over the map, each across all the others: long walls, and no cell without."""
    random = np.random.default_rng(seed)
    return {str(i): random.uniform(0, side, (3, 2)) for i in range(count)}


def beams(count, seed, low=-20.0, high=120.0):
    random = np.random.default_rng(seed)
    return random.uniform(low, high, (count, 2)), random.uniform(-np.pi, np.pi, count)


def town(kind, seed, width):
    """Many walls on a small patch of a plain of 1 km, with long walls through all of it."""
    random = np.random.default_rng(seed)
    plain = {"plain": 1000.0 * np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])}
    long = {f"long {i}": random.uniform(0, 1000, (3, 2)) for i in range(4)}
    streets = {
        "houses": {name: 500 + ring * width / 100 for name, ring in stars(400, seed).items()},
        "lattice": {
            f"{i} {j}": 500
            + width * (np.array([[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1.0]]) / 16)
            for i in range(16)
            for j in range(16)
        },
        "fan": {
            str(i): 500 + width * np.array([[0, 0], *random.uniform(0.2, 1, (2, 2))])
            for i in range(150)
        },  # all through one point: no cell parts them
    }
    return {**plain, **long, **streets[kind]}


WORLDS = {
    "eight stars": stars(8, 1),
    "eighty stars": stars(80, 2),
    "eight hundred stars": stars(800, 3),
    "stars that overlap": stars(100, 4, overlap=3.0),
    "in a room": {"room": ROOM * 12 - 5, **stars(50, 5)},
    "crossing the boundary": {"room": ROOM * 8 + 10, **stars(60, 6)},
    "a tangle": tangle(60, 7),
    "two rings far apart": {"near": DESK, "far": DESK + 80},
    "a hundred corners": stars(4, 8, corners=100),
}


def by_shapely(walls, origin, heading, reach):
    """Ranges by GEOS, which knows nothing of ours."""
    lines = shapely.linestrings(walls.segments)
    ends = origin + reach * np.stack([np.cos(heading), np.sin(heading)], -1)
    rays = shapely.linestrings(np.stack([origin, ends], 1))
    ray, wall = shapely.STRtree(lines).query(rays, predicate="intersects")
    crossing = shapely.intersection(rays[ray], lines[wall])
    ranges = np.full(len(origin), np.inf)
    np.minimum.at(ranges, ray, shapely.distance(shapely.points(origin[ray]), crossing))
    return np.where(np.isinf(ranges), np.nan, ranges)


def by_brute_force(walls, origin, heading):
    return brute_force(walls.segments, *origin.T, np.cos(heading), np.sin(heading))


def one_by_one(walls, origin, heading):
    hits = [walls.first(*o, h) for o, h in zip(origin.tolist(), heading.tolist(), strict=True)]
    return np.array([r for r, _ in hits]), np.array([wall for _, wall in hits])


def assert_all_searches_agree(walls, origin, heading, scale=1.0):
    """Each beam twice, so that there are enough for a batch; and the first few places once more
    with a scan."""
    ranges, _ = expected = by_brute_force(walls, origin, heading)
    assert_same(one_by_one(walls, origin, heading), expected, scale)
    for way in ("plain", *WAYS):
        with taking(way):
            hit = walls.cast(np.repeat(origin, 2, axis=0)[:, None], np.repeat(heading, 2)[:, None])
        assert_same((hit.range[::2, 0], hit.wall[::2, 0]), expected, scale)
    x, y, dx, dy, span = near = near_beams(walls, origin, heading)
    if not len(x):
        return ranges
    expected = brute_force(walls.segments, x, y, dx, dy)
    assert_same(many_beams(walls.flat_grid, x, y, dx, dy), expected, scale)
    ends = walls.segments.reshape(-1, 4)
    *found, doubtful = few_walls(ends, *near)
    assert_same(found, expected, scale, but=doubtful)
    for k in range(min(3, len(x))):
        *found, doubtful = scan(ends, x[k], y[k], dx, dy, span[k])
        same_place = np.full_like(x, x[k]), np.full_like(y, y[k])
        assert_same(found, brute_force(walls.segments, *same_place, dx, dy), scale, but=doubtful)
    return ranges


def assert_same(found, expected, scale, but=()):
    """Ranges to 1e-12, and the same walls; `but` for some beams."""
    ranges, walls = (np.delete(each, but) for each in found)
    expected_ranges, expected_walls = (np.delete(each, but) for each in expected)
    np.testing.assert_allclose(ranges, expected_ranges, rtol=1e-12, atol=1e-12 * scale)
    np.testing.assert_array_equal(walls, expected_walls)


def near_beams(walls, origin, heading):
    """x, y, dx, dy and the coordinates' size of those from where rounding is small against a
    cell."""
    near = np.abs(origin).sum(-1) < walls.grid.horizon
    x, y = origin[near].T
    return (
        x,
        y,
        np.cos(heading[near]),
        np.sin(heading[near]),
        walls.grid.size + np.abs(x) + np.abs(y),
    )


def together(walls, origin, heading):
    """What `nearby_beams` finds; None where they lie too far apart."""
    beams = np.stack([*origin.T, np.cos(heading), np.sin(heading)])
    span = np.abs(walls.segments).max() + np.abs(beams[:2]).sum(axis=0)
    ends = walls.segments.reshape(-1, 4)
    return nearby_beams(ends, beams, beams.min(axis=1), beams.max(axis=1), span)
