"""Small scenes of the other systems, built by hand: one for each kind of sensor."""

import math
from dataclasses import replace

import numpy as np
from scenes import SILENT

from ekfsim.floor import Map, Obstacle
from ekfsim.scene import Scene
from ekfsim.systems import SYSTEMS
from ekfsim.systems.drives import Circle, Square
from ekfsim.systems.instrument import Landmark
from ekfsim.systems.instruments import Bearings, Compass, Gyro, Infrared, Ultrasonic
from ekfsim.world import Told, World

FIELD = tuple(
    Landmark(i, float(x), float(y))
    for i, (x, y) in enumerate([(3, 3), (3, -3), (-3, 3), (-3, -3), (6, 0)])
)
CELLAR = Map(
    np.array([[-1, -1], [3.2, -1], [3.2, 3.2], [-1, 3.2]]),
    (Obstacle("crate", np.array([[0.6, 0.7], [1.3, 0.7], [1.3, 1.4], [0.6, 1.4]])),),
)
SQUARE = np.array([[0, 0], [2, 0], [2, 2], [0, 2.0]])


def driven(
    system,
    drive,
    start=(0.0, 0.0, 0.0),
    floor=Map(),  # noqa: B008
    instruments=None,
    landmarks=FIELD,
    **settings,
):
    """A robot of a system that is driven along a way."""
    made = SYSTEMS[system]
    start = np.array(start, float)
    world = World(
        system, floor, start, np.zeros(3), SILENT, Told(start, np.zeros(3), SILENT, floor),
        landmarks=landmarks,
        system=system, robot=made.robot, instruments=instruments or made.instruments,
    )  # fmt: skip
    return Scene(world, drive=drive, **settings)


def _round(radius=2.0, speed=1.0):
    return Circle(radius, speed)


def mower(**settings):
    return driven("mower", _round(), (0, -2, 0), **settings)


def bearings(**settings):
    return driven("landmarks", _round(), (0, -2, 0), instruments=(Bearings(),), **settings)


def landmarks(**settings):
    return driven("landmarks", _round(), (0, -2, 0), **settings)


def ranges(**settings):
    return driven("ranges", _round(), (0, -2, 0), **settings)


def gnss(**settings):
    return driven("gnss", _round(), (0, -2, 0), landmarks=(), **settings)


def pylon(**settings):
    made = driven(
        "pylon", Square(2.0, 1.0, math.radians(90)), landmarks=(Landmark(1, 1.0, 1.0),), **settings
    )
    return replace(made, world=replace(made.world, expected_path=SQUARE))


def ultrasonic(**settings):
    drive = Square(2.0, 1.0, math.radians(90))
    return driven(
        "pioneer", drive, floor=CELLAR, landmarks=(), instruments=(Ultrasonic(),), **settings
    )


def infrared(**settings):
    drive = Square(2.0, 1.0, math.radians(90))
    return driven(
        "pioneer", drive, floor=CELLAR, landmarks=(), instruments=(Infrared(),), **settings
    )


def yaws(**settings):
    drive = Square(2.0, 1.0, math.radians(90))
    return driven(
        "pioneer", drive, floor=CELLAR, landmarks=(), instruments=(Compass(), Gyro(5.0)), **settings
    )


SCENES = (mower, bearings, landmarks, ranges, gnss, pylon, ultrasonic, infrared, yaws)
