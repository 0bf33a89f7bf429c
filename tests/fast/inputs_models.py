"""States and motion inputs for the motions, states and readings for the sensors."""

import math

import numpy as np
from inputs_rays import DESK, PLACES, ROOM, TURNS
from twin_inputs import axes_of, inputs

from ekfsim.models.layout import INERTIAL, POSE
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.unicycle import Unicycle
from ekfsim.models.motions.wheel_speeds import WheelSpeeds
from ekfsim.models.motions.wheels import GyroWheels
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.laser_by_reading import LaserByReading
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.mounted import Mount, Mounted
from ekfsim.models.sensors.offset import LandmarkOffset
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.raycast.walls import BOUNDARY, Walls

MOTION, SENSOR = (f"ekfsim.models.protocols:{kind}.linearize" for kind in ("Motion", "Sensor"))
MOTIONS = "ekfsim.models.motions"
SEVERAL = {  # of each kind: as it comes, and without noise
    "MoveTurn": (MoveTurn(0.05, 0.1), MoveTurn(0.0, 0.0)),
    "GyroWheels": (GyroWheels(1.41, 0.01, np.eye(3) * 1e-4, 0.02), GyroWheels(0.4, 0.0, 0.0)),
    "Unicycle": (Unicycle(0.02, 0.1), Unicycle(0.0, 0.0)),
    "WheelSpeeds": (WheelSpeeds(0.27, 0.1, 0.3), WheelSpeeds(0.27, 0.0, 0.0)),
}
PILLARS = {"pillar": np.array([7, 2, 1.0]), "vault": np.array([4.5, 5, 1.5])}
WALLS = (
    Walls.of({BOUNDARY: ROOM, "desk": DESK}),
    Walls.of({BOUNDARY: ROOM, "desk": DESK}, circles=PILLARS),
    Walls.of({"desk": DESK}),
    Walls.of({}),
)
# of a range, see inputs_rays.py; of its derivative by the heading, where a beam grazes a wall
SHORT = 1e-9


def states(random, runs, n=3):
    """Anywhere, and with headings as they hardly ever are."""
    axes = axes_of(runs)
    x = random.uniform(-4, 11, (*axes, n))
    yield x
    for heading in TURNS:
        turned = x.copy()
        turned[..., 1 if n == 4 else 2] = heading
        yield turned


def moved(kind):
    """What goes into a motion: as it comes; at rest; turned by π; and when no time has passed."""

    def make(random, runs):
        for motion in SEVERAL[kind]:
            m, axes = len(motion.inputs), axes_of(runs)
            for x in states(random, runs, 4 if kind == "WheelSpeeds" else 3):
                u = random.uniform(-1, 1, (*axes, m))
                u[..., -1] = abs(u[..., -1]) if m > 2 else u[..., -1]
                yield motion, x, u
                yield motion, x, np.zeros_like(u)
                yield motion, x, np.round(u) * math.pi

    return make


for each in SEVERAL:
    inputs(MOTION, each)(moved(each))
inputs(f"{MOTIONS}.move_turn:MoveTurn.f")(moved("MoveTurn"))
inputs(f"{MOTIONS}.wheels:GyroWheels.f")(moved("GyroWheels"))
inputs(f"{MOTIONS}.unicycle:Unicycle.f")(moved("Unicycle"))


def poses(random, runs):
    """Where beams begin: anywhere, and at corners, along walls."""
    yield from states(random, runs)
    corner = random.choice(PLACES, (*axes_of(runs), 3))
    corner[..., 2] = random.choice(TURNS, axes_of(runs))
    yield corner


@inputs(SENSOR, "Laser", within=SHORT)
def lasers(random, runs):
    for walls in WALLS:
        for bearing, ratio in ((0.0, 0.01), (0.7, 0.0)):
            yield from ((Laser(walls, bearing, ratio), x) for x in poses(random, runs))


@inputs(SENSOR, "LaserByReading", within=SHORT)
def lasers_by_reading(random, runs):
    axes = axes_of(runs)
    z = random.uniform(0, 5, (*axes, 1))
    for walls in WALLS:
        for read in (z, np.where(random.random(z.shape) < 0.3, np.nan, z)):
            sensor = LaserByReading(walls, 0.3, 0.05, read)
            yield from ((sensor, x) for x in poses(random, runs))
            yield sensor, random.uniform(1, 7, (*axes, 7, 3))  # sigma points


@inputs(SENSOR, "UltrasonicBeam", within=SHORT)
def ultrasonic_beams(random, runs):
    for walls in WALLS:
        sensor = UltrasonicBeam(walls, 0.4, 0.005, 0.01)
        yield from ((sensor, x) for x in poses(random, runs))


@inputs(SENSOR, "InfraredBeam", within=SHORT)
def infrared_beams(random, runs):
    for walls in WALLS:
        sensor = InfraredBeam(walls, -0.4, 1.0, 1.2, 0.6, 0.05)
        yield from ((sensor, x) for x in poses(random, runs))


def markers():
    """As the document has them; with its misprint; seen from a state of seven."""
    yield MarkerAngles(2.0, 3.0, 0.226, 0.048, 0.006), 3
    yield MarkerAngles(2.0, 3.0, 0.226, 0.0, 0.0, -1.0), 3
    yield MarkerAngles(2.0, 3.0, 0.226, 0.048, 0.006, layout=INERTIAL), 7


LANDMARKS = {
    "MarkerAngles": lambda: list(markers()),
    "RangeBearing": lambda: around(RangeBearing, 0.1, 0.02),
    "RangeOnly": lambda: around(RangeOnly, 0.1),
    "BearingOnly": lambda: around(BearingOnly, 0.02),
    "LidarOffset": lambda: around(LidarOffset, 0.1),
    "LandmarkOffset": lambda: [
        *around(LandmarkOffset, 0.1, 0.2),
        (LandmarkOffset(2.0, 3.0, 0.1, 0.2, yaw_sigma=0.05), 3),
    ],
}


def around(kind, *sigmas):
    """A sensor of one landmark; without noise; seen from a state of seven."""
    yield kind(2.0, 3.0, *sigmas), 3
    yield kind(2.0, 3.0, *(0.0 for _ in sigmas)), 3
    yield kind(2.0, 3.0, *sigmas, INERTIAL), 7


def seen(kind):
    """Landmarks from anywhere, and from where they stand."""

    def make(random, runs):
        for sensor, n in LANDMARKS[kind]():
            for x in states(random, runs, n):
                yield sensor, x
                at_it = x.copy()
                at_it[..., sensor.layout.position] = sensor.x, sensor.y
                yield sensor, at_it

    return make


for each in LANDMARKS:
    inputs(SENSOR, each)(seen(each))


@inputs(SENSOR, "Mounted", within=SHORT)
def mounted_sensors(random, runs):
    """Beside the pose and half turned round, on a state that is a pose and on one of seven."""
    for sensor in (UltrasonicBeam(WALLS[0], 0.4, 0.005, 0.01), next(markers())[0]):
        for layout in (POSE, INERTIAL):
            for x in states(random, runs, len(layout.names)):
                yield Mounted(sensor, Mount(0.3, -0.2, 2.5), layout), x


@inputs(SENSOR, "Frozen", within=SHORT)
def frozen_sensors(random, runs):
    axes = axes_of(runs)
    at = random.uniform(1, 7, (*axes, 3))
    for sensor in (Laser(WALLS[0], 0.3, 0.05), next(markers())[0]):
        yield Frozen(sensor, at), at + 1
        yield Frozen(sensor, at), random.uniform(1, 7, (*axes, 7, 3))  # sigma points


@inputs("ekfsim.models.sensors.landmarks:MarkerAngles.residual")
def marker_readings(random, runs):
    axes, (sensor, _) = axes_of(runs), next(markers())
    z, h = random.uniform(-math.pi, math.pi, (2, *axes, 2))
    yield sensor, z, h
    yield sensor, z, z + math.pi
    yield sensor, z, np.where(random.random(h.shape) < 0.3, np.nan, h)


@inputs("ekfsim.diagnostics.ambiguity:sighting", within=1e-7)
def sightings(random, runs):
    """Wide beliefs and none, some of them flat.

    within : the eigenvectors of P have half its digits where two eigenvalues are near each other
    """
    axes = axes_of(runs)
    for walls in WALLS[:3]:
        x = random.uniform((0, 0, -math.pi), (10, 8, math.pi), (*axes, 3))
        root = random.normal(size=(*axes, 3, 3)) * [[0.2], [0.2], [0.1]]
        for P in (root @ root.mT, 0 * root, root[..., :1] * root[..., None, :, 0]):
            yield Laser(walls, 0.5, 0.01), x, P
