"""Logs written by hand that the tests share: fixed numbers, whatever any random generator does."""

import math
from dataclasses import replace

import numpy as np
from scenes import ROOM, world

from ekfsim.filters.belief import Gaussian
from ekfsim.models.layout import SPEED_POSE
from ekfsim.models.motions.wheel_speeds import WheelSpeeds
from ekfsim.models.motions.wheels import GyroWheels
from ekfsim.models.sensors.landmarks import MarkerAngles, RangeOnly
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.raycast.walls import Walls
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.scene import Scene
from ekfsim.systems import SYSTEMS

FIRST = Gaussian(np.array([1.0, 2.0, math.radians(10)]), np.diag([0.05, 0.05, 0.02]) ** 2)
WHEELS = GyroWheels(0.6, 0.01, np.diag([0.004, 0.004, 0.002]) ** 2)
MARKER = MarkerAngles(5.0, 3.0, 0.226, 0.048, 0.006)
NODE = RangeOnly(0.0, 0.0, 0.1)
FIX = Position(0.2, 0.2)
BEAM = UltrasonicBeam(Walls.of({"boundary": ROOM}), math.pi / 2, 0.005, 0.01, 0.1, 2.0)


def wheels(left, right, rate, dt=0.5):
    return Control(WHEELS, np.array([left, right, math.radians(rate), dt]))


def entry(index, t, given, truth, **what):
    x, y, degrees = truth
    return Entry(index, given, np.array([x, y, math.radians(degrees)]), t=t, **what)


MOWER = (
    entry(0, 10.0, None, (1.02, 1.98, 11)),
    entry(1, 10.5, wheels(0.24, 0.26, 4), (1.26, 2.02, 12.5)),
    entry(2, 11.0, wheels(0.25, 0.27, 5), (1.51, 2.07, 15)),
    entry(3, 11.0, Reading(MARKER, np.radians([0.5, -3.2]), "marker 3"), (1.51, 2.07, 15)),
    entry(4, 11.0, Reading(NODE, np.array([2.5]), "node 1"), (1.51, 2.07, 15)),
    entry(5, 11.5, wheels(0.25, 0.25, 0), (1.75, 2.14, 15), fix=np.array([2.0, 2.5])),
    entry(6, 11.6, Reading(FIX, np.array([2.8, 1.1]), "gnss"), (1.75, 2.14, 15), judged=False),
    entry(7, 12.0, Reading(BEAM, np.array([np.nan]), "ultrasonic 2"), (1.75, 2.14, 15)),
    entry(8, 12.5, wheels(0.1, 0.1, -1), (1.85, 2.17, 14)),
)


def recording(entries=MOWER, first=FIRST, **settings):
    """A recorded mower. Its sensors are those of several robots, so that each has its turn."""
    robot, instruments = SYSTEMS["mower"].robot, SYSTEMS["mower"].instruments
    place = replace(world(), system="mower", robot=robot, instruments=instruments)
    return Scene(
        place, log=Log(tuple(entries), first), log_source="log.csv", **{"gate": 0.999, **settings}
    )


SPEEDS = WheelSpeeds(0.27, 0.1, 0.3)
SPEED_FIRST = Gaussian(np.array([0.0, 0.1, 1.0, 2.0]), np.diag([1.0, 0.05, 0.05, 0.05]) ** 2)


def speeds(inputs, fixes, dt=0.1):
    """A recorded lawn mower: so many wheel speeds, and a fix after every `fixes` of them. No truth
    is known."""
    entries, t = [Entry(0, None, t=0.0)], 0.0
    for k in range(1, inputs + 1):
        t = k * dt
        entries.append(Entry(len(entries), Control(SPEEDS, np.array([0.9, 1.1, dt])), t=t))
        if k % fixes == 0:
            z = np.array([1.0 + t, 2.0 + 0.1 * t])
            entries.append(
                Entry(len(entries), Reading(Position(0.15, 0.15, SPEED_POSE), z, "gnss"), t=t)
            )
    place = replace(world(), system="gnss", robot=SYSTEMS["gnss"].robot)
    return Scene(place, log=Log(tuple(entries), SPEED_FIRST))
