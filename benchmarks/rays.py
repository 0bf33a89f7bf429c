"""One beam, a scan, and beams from different places: ekfsim, ir-sim's lidar and shapely side by
side.

python benchmarks/rays.py [--quick] [one|scan|places ...]

Many beams are timed with NumPy alone and, where it is installed, with Numba (the extra `fast`). All
on one processor.
"""

import argparse
import math
import os
from collections.abc import Callable, Iterator, Mapping
from itertools import cycle
from types import SimpleNamespace
from typing import Any

# before NumPy is there: what two threads do is no one's merit
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import shapely
from timing import WAYS, Task, optional, ratios

from ekfsim import twins
from ekfsim.geometry import Array
from ekfsim.raycast.walls import Walls

SIDE = 100.0  # m
REACH = 150.0  # m, more than the map's diagonal: the peers' beams have an end
CORNERS = 5
DIFFERENT = 64  # beams that take turns
SCAN = 360  # beams of a scan
# by the number of walls, of 100 000 beams those that a slow peer is timed with, else 200
SOME = {400: 1000, 40: 2000}

Beam = tuple[float, float, float]  # x, y in m, heading in rad
Cast = Callable[[float, float, float], float]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="fewer and shorter rounds, and not the largest maps"
    )
    parser.add_argument(
        "what",
        nargs="*",
        default=["one", "scan", "places"],
        help="one, scan, places; all if not said",
    )
    options = parser.parse_args()
    effort = (3, 0.005) if options.quick else (9, 0.02)
    if "one" in options.what:
        for count in (40, 4000) if options.quick else (40, 4000, 40000):
            one_beam(count, effort)
    if "scan" in options.what:
        for count in (400,) if options.quick else (40, 400, 4000):
            scan(count, effort)
    if "places" in options.what:
        for count, beams in ((40, 1000), (400, 1000)) if options.quick else PLACES:
            places(count, beams, effort)


PLACES = (
    (40, 1000),
    (400, 1000),
    (40, 7000),
    (400, 7000),
    (40, 100_000),
    (400, 100_000),
    (40_000, 100_000),
)


def one_beam(count: int, effort: tuple[int, float]) -> None:
    """One beam at a time."""
    rings = world(count)
    walls = Walls.of(rings)
    beams = free_beams(rings)
    casts = {
        "shapely STRtree": by_tree(walls),
        "shapely, one union": by_union(walls),
        **by_irsim(rings),
    }
    check(walls, casts, beams)
    print(f"one beam, {count} walls")
    peers = {name: turns(cast, beams) for name, cast in casts.items()}
    for ratio in ratios(turns(walls.first, beams), peers, *effort):
        print(ratio)


def scan(count: int, effort: tuple[int, float]) -> None:
    """A scan from one place; times are those of one of its beams."""
    rings = world(count)
    walls = Walls.of(rings)
    x, y, heading = free_beams(rings)[0]
    lidar = irsim_lidar(rings, SCAN)
    angles = heading + np.linspace(-np.pi, np.pi, SCAN)
    peers: dict[str, Task] = {}
    if lidar is not None:
        pose = np.array([[x], [y], [heading]])
        peers[f"ir-sim Lidar2D.step, {SCAN} beams"] = lambda: lidar.step(pose)
        lidar.step(pose)
        agree(walls.cast(np.array([x, y]), heading + lidar.angle_list).range, lidar.range_data)
    compare(
        f"a scan of {SCAN} beams, {count} walls", walls, np.array([x, y]), angles, peers, {}, effort
    )


def places(count: int, beams: int, effort: tuple[int, float]) -> None:
    """As many beams from as many places; times are those of one of them. Slow peers get fewer."""
    rings = world(count)
    walls = Walls.of(rings)
    random = np.random.default_rng(2)
    origins = free_places(rings, beams, seed=3)
    angles = random.uniform(-np.pi, np.pi, beams)
    some = min(beams, SOME.get(count, 200))
    edges = shapely.linestrings(walls.segments)
    tree = shapely.STRtree(edges)
    casts: dict[str, Callable[[], Array]] = {
        "shapely STRtree, all beams in one query": lambda: all_by_tree(
            tree, edges, origins[:some], angles[:some]
        )
    }
    module: Any = optional("irsim.lib.algorithm.ray_casting_2d")
    if module is not None:
        casts["ir-sim's kernel cast_ray_segments, a call a place"] = lambda: by_kernel(
            module.cast_ray_segments, walls, origins[:some], angles[:some]
        )
    for cast in casts.values():
        agree(walls.cast(origins[:some], angles[:some]).range, cast())
    title = f"{beams} beams from different places, {count} walls"
    compare(title, walls, origins, angles, casts, dict.fromkeys(casts, beams / some), effort)


def compare(
    title: str,
    walls: Walls,
    origins: Array,
    angles: Array,
    peers: Mapping[str, Task],
    calls: Mapping[str, float],
    effort: tuple[int, float],
) -> None:
    """Print how NumPy and Numba fare; first that they answer alike."""
    plain = walls.cast(origins, angles)
    for name, way in WAYS.items():
        if way == "compiled" and optional("numba") is None:
            continue
        twins.take(way)
        hit = walls.cast(origins, angles)
        np.testing.assert_allclose(hit.range, plain.range, rtol=1e-12, atol=1e-12)
        print(f"{title}, {name}")
        for ratio in ratios(
            lambda: walls.cast(origins, angles), peers, *effort, calls, len(angles)
        ):
            print(ratio)
    twins.take("quick")


def agree(ours: Array, theirs: Array) -> None:
    """Who answers another question is no peer."""
    np.testing.assert_allclose(theirs, np.where(np.isnan(ours), REACH, ours), atol=1e-6)


def world(count: int) -> dict[str, Array]:
    """`count` walls: star-shaped pentagons, one in each cell of a lattice, so that none touches
    another.
    """
    random, pieces = np.random.default_rng(0), count // CORNERS
    lattice = math.ceil(math.sqrt(pieces))
    pitch = SIDE / lattice
    rings = {}
    for place in random.permutation(lattice**2)[:pieces]:
        angle = (np.arange(CORNERS) + random.uniform(0.1, 0.9, CORNERS)) * 2 * np.pi / CORNERS
        radius = pitch * random.uniform(0.2, 0.42, (CORNERS, 1))
        centre = (np.array(divmod(place, lattice)) + 0.5) * pitch
        rings[f"star {place}"] = centre + radius * np.stack([np.cos(angle), np.sin(angle)], -1)
    return rings


def free_beams(rings: dict[str, Array]) -> list[Beam]:
    """Beams from places outside all polygons."""
    free = free_places(rings, DIFFERENT, seed=1).tolist()
    headings = np.random.default_rng(2).uniform(-3.1, 3.1, DIFFERENT).tolist()
    return [(x, y, heading) for (x, y), heading in zip(free, headings, strict=True)]


def free_places(rings: dict[str, Array], count: int, seed: int) -> Array:
    """Places outside all polygons : (count, 2)"""
    random = np.random.default_rng(seed)
    tree = shapely.STRtree(shapely.polygons(list(rings.values())))
    found = np.empty((0, 2))
    while len(found) < count:
        origins = random.uniform(2, SIDE - 2, (count, 2))
        inside = tree.query(shapely.points(origins), predicate="intersects")[0]
        found = np.concatenate([found, np.delete(origins, inside, 0)])
    return found[:count]


def turns(cast: Callable[[float, float, float], object], beams: list[Beam]) -> Callable[[], object]:
    """A task that casts the next of the beams at each call."""
    upcoming: Iterator[Beam] = cycle(beams)
    return lambda: cast(*next(upcoming))


def check(walls: Walls, casts: dict[str, Cast], beams: list[Beam]) -> None:
    """Who answers another question is no peer."""
    for name, cast in casts.items():
        for beam in beams[:8]:
            expected = walls.first(*beam)[0]
            expected = REACH if math.isnan(expected) else expected
            if not math.isclose(cast(*beam), expected, abs_tol=1e-6):
                raise AssertionError(f"{name} finds {cast(*beam)} m for {beam}, not {expected} m")


def line(x: float, y: float, heading: float) -> shapely.LineString:
    return shapely.LineString(
        [(x, y), (x + REACH * math.cos(heading), y + REACH * math.sin(heading))]
    )


def by_tree(walls: Walls) -> Cast:
    """GEOS's tree of walls, then the nearest of the crossings."""
    edges = shapely.linestrings(walls.segments)
    tree = shapely.STRtree(edges)

    def cast(x: float, y: float, heading: float) -> float:
        beam = line(x, y, heading)
        crossings = shapely.intersection(beam, edges[tree.query(beam, predicate="intersects")])
        return float(shapely.distance(shapely.Point(x, y), crossings).min(initial=REACH))

    return cast


def by_union(walls: Walls) -> Cast:
    """What a first program does: intersect the beam with everything."""
    everything = shapely.multilinestrings(shapely.linestrings(walls.segments))

    def cast(x: float, y: float, heading: float) -> float:
        crossings = line(x, y, heading).intersection(everything)
        return REACH if crossings.is_empty else shapely.Point(x, y).distance(crossings)

    return cast


def all_by_tree(tree: shapely.STRtree, edges: Any, origins: Array, angles: Array) -> Array:
    """GEOS's tree asked for all beams at once, then the nearest of each beam's crossings."""
    ends = origins + REACH * np.stack([np.cos(angles), np.sin(angles)], -1)
    rays = shapely.linestrings(np.stack([origins, ends], 1))
    ray, wall = tree.query(rays, predicate="intersects")
    crossings = shapely.intersection(rays[ray], edges[wall])
    ranges = np.full(len(origins), REACH)
    np.minimum.at(ranges, ray, shapely.distance(shapely.points(origins)[ray], crossings))
    return ranges


def by_kernel(
    kernel: Callable[..., tuple[Array, Array]], walls: Walls, origins: Array, angles: Array
) -> Array:
    """ir-sim's kernel knows one origin at a time."""
    directions = np.stack([np.cos(angles), np.sin(angles)], -1)[:, None]
    a, b = walls.segments[:, 0], walls.segments[:, 1]
    return np.array(
        [kernel(o, d, a, b, REACH)[0][0] for o, d in zip(origins, directions, strict=True)]
    )


def by_irsim(rings: dict[str, Array]) -> dict[str, Cast]:
    """ir-sim's own lidar with one beam."""
    lidar = irsim_lidar(rings, 1)
    if lidar is None:
        return {}

    def cast(x: float, y: float, heading: float) -> float:
        lidar.step(np.array([[x], [y], [heading]]))
        return float(lidar.range_data[0])

    return {"ir-sim Lidar2D.step, one beam": cast}


def irsim_lidar(rings: dict[str, Array], beams: int) -> Any:
    """ir-sim's own lidar in an environment reduced to what that lidar asks of it; None where it is
    not installed.
    """
    module: Any = optional("irsim.world.sensors.lidar2d")
    if module is None:
        return None
    polygons = [shapely.Polygon(ring) for ring in rings.values()]
    for polygon in polygons:
        shapely.prepare(polygon)
    objects = [
        SimpleNamespace(
            _id=i, _geometry=polygon, _geometry_valid=True, unobstructed=False, shape="polygon"
        )
        for i, polygon in enumerate(polygons, start=1)
    ]
    parameters = SimpleNamespace(objects=objects, GeometryTree=shapely.STRtree(polygons))
    lidar = module.Lidar2D(
        np.zeros((3, 1)), obj_id=0, range_max=REACH, number=beams, angle_range=2 * np.pi
    )
    lidar.parent = SimpleNamespace(_env=SimpleNamespace(_env_param=parameters))
    return lidar


if __name__ == "__main__":
    main()
