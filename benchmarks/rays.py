"""One beam against 40, 4 000 and 40 000 walls: ekfsim, ir-sim's lidar and shapely side by side.

python benchmarks/rays.py [--quick]
"""

import argparse
import math
from collections.abc import Callable, Iterator
from itertools import cycle
from types import SimpleNamespace
from typing import Any

import numpy as np
import shapely
from timing import optional, ratios

from ekfsim.geometry import Array
from ekfsim.geometry.walls import Walls

SIDE = 100.0  # m
REACH = 150.0  # m, more than the map's diagonal: the peers' beams have an end
CORNERS = 5
DIFFERENT = 64  # beams that take turns

Beam = tuple[float, float, float]  # x, y in m, heading in rad
Cast = Callable[[float, float, float], float]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer and shorter rounds, and not the largest map")
    quick = parser.parse_args().quick
    for count in (40, 4000) if quick else (40, 4000, 40000):
        rings = world(count)
        walls = Walls.of(rings)
        beams = free_beams(rings)
        casts = {"shapely STRtree": by_tree(walls), "shapely, one union": by_union(walls), **by_irsim(rings)}
        check(walls, casts, beams)
        print(f"{count} walls")
        ours = turns(walls.first, beams)
        peers = {name: turns(cast, beams) for name, cast in casts.items()}
        for ratio in ratios(ours, peers, *((3, 0.005) if quick else (9, 0.02))):
            print(ratio)


def world(count: int, seed: int = 0) -> dict[str, Array]:
    """`count` walls: star-shaped pentagons, one in each cell of a lattice, so that none touches another."""
    random, pieces = np.random.default_rng(seed), count // CORNERS
    lattice = math.ceil(math.sqrt(pieces))
    pitch = SIDE / lattice
    rings = {}
    for place in random.permutation(lattice**2)[:pieces]:
        angle = (np.arange(CORNERS) + random.uniform(0.1, 0.9, CORNERS)) * 2 * np.pi / CORNERS
        radius = pitch * random.uniform(0.2, 0.42, (CORNERS, 1))
        centre = (np.array(divmod(place, lattice)) + 0.5) * pitch
        rings[f"star {place}"] = centre + radius * np.stack([np.cos(angle), np.sin(angle)], -1)
    return rings


def free_beams(rings: dict[str, Array], seed: int = 1) -> list[Beam]:
    """Beams from places outside all polygons."""
    random = np.random.default_rng(seed)
    tree = shapely.STRtree(shapely.polygons(list(rings.values())))
    origins = random.uniform(2, SIDE - 2, (50 * DIFFERENT, 2))
    inside = tree.query(shapely.points(origins), predicate="intersects")[0]
    free = np.delete(origins, inside, 0)[:DIFFERENT]
    return [(x, y, h) for (x, y), h in zip(free.tolist(), random.uniform(-3.1, 3.1, len(free)).tolist(), strict=True)]


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
    return shapely.LineString([(x, y), (x + REACH * math.cos(heading), y + REACH * math.sin(heading))])


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


def by_irsim(rings: dict[str, Array]) -> dict[str, Cast]:
    """ir-sim's own lidar with one beam, in an environment reduced to what that lidar asks of it."""
    module: Any = optional("irsim.world.sensors.lidar2d")
    if module is None:
        return {}
    polygons = [shapely.Polygon(ring) for ring in rings.values()]
    for polygon in polygons:
        shapely.prepare(polygon)
    objects = [
        SimpleNamespace(_id=i, _geometry=polygon, _geometry_valid=True, unobstructed=False, shape="polygon")
        for i, polygon in enumerate(polygons, start=1)
    ]
    parameters = SimpleNamespace(objects=objects, GeometryTree=shapely.STRtree(polygons))
    lidar = module.Lidar2D(np.zeros((3, 1)), obj_id=0, range_max=REACH, number=1)
    lidar.parent = SimpleNamespace(_env=SimpleNamespace(_env_param=parameters))

    def cast(x: float, y: float, heading: float) -> float:
        lidar.step(np.array([[x], [y], [heading]]))
        return float(lidar.range_data[0])

    return {"ir-sim Lidar2D.step, one beam": cast}


if __name__ == "__main__":
    main()
