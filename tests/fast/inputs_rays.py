"""Beams among walls, and ways that end in them."""

import numpy as np
from twin_inputs import axes_of, inputs

from ekfsim.raycast.walls import BOUNDARY, Walls

ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
DESK = np.array([[2, 2], [4, 2], [4, 3], [2, 3.0]])
LINES = {"hook": np.array([[7, 0], [7, 5], [9, 5.0]]), "bow": np.array([[1, 5], [3, 7], [3, 5.0]])}
CIRCLES = {
    "pillar": np.array([7, 2, 1.0]),  # across a line
    "tun": np.array([4, 2, 2.0]),  # about a corner of the desk
    "vault": np.array([4.5, 5, 1.5]),  # round where most stand
    "pea": np.array([9, 7, 0.01]),
}
PLACES = (0.0, 2.0, 3.0, 4.0, 10.0)  # of corners, and on walls
TURNS = np.array([-np.pi, -np.pi / 2, 0.0, np.pi / 4, np.pi / 2, np.pi])
# of a range: it has the digits of the coordinates, and those are up to a thousand times as large
SHORT = 1e-9


def worlds(random):
    """A room with a desk; one that is full of triangles; triangles alone; nothing; a room with
    lines and circles; circles alone, which cross; lines alone.
    """
    full = {
        str(i): random.uniform(0.5, 7.5, 2) + random.uniform(-0.4, 0.4, (3, 2)) for i in range(80)
    }
    yield Walls.of({BOUNDARY: ROOM, "desk": DESK})
    yield Walls.of({BOUNDARY: ROOM, **full})
    yield Walls.of(dict(list(full.items())[:25]))
    yield Walls.of({})
    yield Walls.of({BOUNDARY: ROOM, "desk": DESK}, LINES, CIRCLES)
    yield Walls.of({}, circles=CIRCLES)
    yield Walls.of({}, LINES)


@inputs("ekfsim.raycast.walls:Walls.cast", within=SHORT)
def beams(random, runs):
    axes = axes_of(runs)
    for walls in worlds(random):
        origin, heading = random.uniform(-1, 11, (*axes, 2)), random.uniform(-np.pi, np.pi, axes)
        yield walls, origin, heading
        yield walls, np.array([5.0, 4.5]), heading
        yield walls, 5 + 0.01 * random.normal(size=(*axes, 2)), 0.02 * heading
        yield walls, random.choice(PLACES, (*axes, 2)), random.choice(TURNS, axes)
        yield walls, origin[..., None, :], heading[..., None] + TURNS
        strays = np.where(random.random(axes) < 0.2, np.nan, heading)
        yield walls, np.where(random.random((*axes, 1)) < 0.1, 1e13, origin), strays


@inputs("ekfsim.raycast.walls:Walls.first", within=SHORT)
def single_beams(random, runs):
    for walls in worlds(random) if runs is None else ():
        for x, y, heading in random.uniform(-4, 11, (20, 3)).tolist():
            yield walls, x, y, heading
        for x, y in random.choice(PLACES, (20, 2)).tolist():
            yield walls, x, y, float(random.choice(TURNS))
        for odd in (np.nan, np.inf, 1e13):
            yield from ((walls, odd, 1.0, 0.5), (walls, 1.0, 1.0, odd))


@inputs("ekfsim.raycast.ground:Ground.reach")
def ways(random, runs):
    axes = axes_of(runs)
    for walls in worlds(random):
        place = random.uniform(-1, 11, (*axes, 1, 2))
        way = random.uniform(-5, 5, (*axes, 6, 2))
        yield walls.ground, place, way
        yield walls.ground, place, 0 * way
        yield walls.ground, random.choice(PLACES, place.shape), way
        yield walls.ground, np.where(random.random(place.shape) < 0.3, np.nan, place), way


@inputs("ekfsim.simulation.classroom:until_wall", within=SHORT)
def drives(random, runs):
    axes = axes_of(runs)
    for walls in worlds(random):
        pose = random.uniform((-1, -1, -np.pi), (11, 9, np.pi), (*axes, 3))
        way = random.uniform(-5, 5, axes)
        yield walls, pose, way
        yield walls, pose, 0 * way
        yield walls, (5, 4.5, 0.1) + 0.02 * pose, 0.01 * way - 3
        square = random.choice(PLACES, (*axes, 2)), random.choice(TURNS, (*axes, 1))
        yield walls, np.concatenate(square, axis=-1), np.rint(way)
        yield walls, np.where(random.random(pose.shape) < 0.1, np.nan, pose), way


@inputs("ekfsim.simulation.classroom:paired")
def measured(random, runs):
    d, a = random.normal(size=(2, *axes_of(runs)))
    yield d, a
    yield d, 0.5
