"""Worlds and scenes that the tests share, built by hand."""

import math
from dataclasses import replace

import numpy as np

from ekfsim.commands import Kidnap, Move, Repeat, Say, Sense
from ekfsim.floor import Map, Obstacle, RoundObstacle, WallLine
from ekfsim.scene import Scene
from ekfsim.world import Faults, Noise, Told, World

NOISE = Noise(0.05, 0.04, 0.02, 0.03, 0.01)
SILENT = Noise(0.0, 0.0, 0.0, 0.0, 0.0)
ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
DESK = Obstacle("desk", np.array([[4, 3], [5, 3], [5, 4], [4, 4.0]]))
# two of its edges on one line
STEP = Obstacle("step", np.array([[7, 5], [8, 5], [9, 5], [9, 5.5], [7, 5.5]]))
ROUND = Obstacle("post", np.array([[2, 6], [2.4, 6.1], [2.3, 6.6], [1.9, 6.4]]))
START = (1.0, 1.0, math.radians(30))


def world(start=START, sigma=(0, 0, 0), noise=NOISE, obstacles=(), boundary=ROOM, faults=Faults()):  # noqa: B008
    """A world in which the filter is told the truth."""
    plan = Map(boundary, tuple(obstacles))
    start, sigma = np.array(start, float), np.array(sigma, float)
    return World("test", plan, start, sigma, noise, Told(start, sigma, noise, plan), faults)


def scene(*commands, seed=0, run=0, filter="ekf", gate=None, guard="warn", **described):
    return Scene(
        world(**described), commands, seed=seed, run=run, filter=filter, gate=gate, guard=guard
    )


def told(scene, **otherwise):
    """The same scene, but the filter is told another start, sigma, noise or map."""
    return replace(scene, world=replace(scene.world, told=replace(scene.world.told, **otherwise)))


def rich(seed=3, gate=0.9, guard="warn"):
    """Everything that can happen to a robot: faults, a wrong map, slips, bumps, a kidnapping, all
    four refusals."""
    wrong = Map(ROOM, (STEP, ROUND))  # no desk
    faults = Faults(0.05, 1.02, 0.2, 1.03, 0.98)
    course = (
        Sense(math.radians(20)),
        Move(2.0, math.radians(15)),
        Say("Now watch the ellipse."),
        Sense(math.radians(-60)),
        Move(1.0, math.radians(80), slip=0.4),
        Repeat(
            2, (Sense(math.radians(10)), Move(-0.7, math.radians(-35)), Sense(math.radians(170)))
        ),
        Move(30.0, math.radians(200)),
        Sense(0.0),
        Kidnap(3.0, 2.0, math.radians(-170)),
        Repeat(3, (Sense(math.radians(95)), Move(1.5, 0.0), Sense(math.radians(-100)))),
        Move(0.0, math.radians(-90), slip=1.0),
        Move(1.2, math.radians(400), slip=1.0),
        *(Sense(math.radians(angle)) for angle in range(-180, 180, 24)),
    )
    place = {"obstacles": (DESK, STEP, ROUND), "sigma": (0.1, 0.1, 0.05), "faults": faults}
    made = scene(*course, seed=seed, gate=gate, guard=guard, **place)
    return told(
        made,
        map=wrong,
        noise=replace(NOISE, odometry_distance=0.03),
        start=np.array([1.05, 0.95, 0.5]),
    )


def among_pillars(seed=3):
    """The same course among walls that stand free and round ones, one of which is on no map."""
    made = rich(seed)
    lines = (WallLine("hook", np.array([[6.5, 0], [6.5, 2.5], [8, 2.5]])),)
    thick = RoundObstacle("thick", np.array([5.5, 4.5]), 0.8)
    unknown = RoundObstacle("unknown", np.array([2.5, 3.5]), 0.3)
    world = replace(made.world, map=Map(ROOM, (DESK, thick, unknown), lines))
    return told(replace(made, world=world), map=Map(ROOM, (thick, STEP), lines))


def unbounded(seed=1):
    """No boundary: some beams meet nothing, in truth, in the map, or in both."""
    course = tuple(
        c for a in range(0, 360, 15) for c in (Sense(math.radians(a)), Move(0.1, math.radians(3)))
    )
    made = scene(
        *course,
        seed=seed,
        boundary=None,
        obstacles=(DESK, STEP),
        start=(5.5, 4.6, 0),
        sigma=(0.05, 0.05, 0.02),
    )
    return told(made, map=Map(None, (STEP, ROUND)))
