"""A robot that is driven along a way, its instruments read at their own rates: world + drive + draws → Entries."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ekfsim.filters.unscented import square_root
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import angles
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.simulation.draws import Draws, true_start
from ekfsim.systems.drives import Course, Drive
from ekfsim.systems.instruments import Instrument, Pylon, Target
from ekfsim.systems.robots import PylonCart, Tick

ALONG, ACROSS, AROUND = 1.0, 1.0, 2.0  # 1/s, rad/s per m, 1/s: how hard the driver steers back to the way
GPS_SIGMA, GPS_PERIOD = 0.4, 2.0  # m, s: of the pylon cart's GPS, which is recorded and not used
SOON = 1e-9  # of a period: what rounding makes of an instant


def drive(scene: Scene, way: Drive, draws: Draws) -> Iterator[Entry]:
    """The log of a driven robot: at every tick its motion input, then the readings of that instant, one after another.

    The truth follows the right equations whatever reading of the document the filter follows. Draws are numbered by
    all that could be drawn, seen or not: 0 is the start; then for each tick the disturbance of the motion, the noise
    of its input, and one for every target.
    """
    world, robot = scene.world, scene.world.robot
    assert robot is not None
    told_motion, motion, dt = robot.motion(scene.reading), robot.motion("corrected"), 1 / robot.rate
    told, true = world.targets(scene.reading, world.told.map), world.targets("corrected", world.map)
    course = way.course(dt)
    wanted = course.poses(world.start, dt)
    truth, index, velocity, fix = true_start(world, draws), 0, np.zeros(2), None
    yield Entry(0, None, truth, t=0.0)
    for tick in range(len(course.speed)):
        drawn, t = 1 + tick * (2 + len(told)), (tick + 1) * dt
        speed, turn_rate = _steered(course, tick, wanted[tick], truth)
        moved = _moved(truth, speed * dt, turn_rate * dt, velocity, dt)
        ideal, disturbances = robot.ideal(moved), draws.normals(drawn)
        truth, velocity = _disturbed(moved.after, motion.Q(ideal), disturbances), moved.velocity_after
        u = ideal + _noise(motion.M(ideal), draws.normals(drawn + 1))
        if isinstance(robot, PylonCart) and _due(1 / GPS_PERIOD, tick, dt):
            fix = truth[..., :2] + GPS_SIGMA * np.stack(disturbances[:2], axis=-1)
        index += 1
        yield Entry(index, Control(told_motion, u), truth, t=t, fix=fix)
        for number, (instrument, target) in enumerate(told):
            if not _due(instrument.rate, tick, dt) or not np.any(instrument.sees(target, truth)):
                continue
            x, normals = world.layout.state(truth), draws.normals(drawn + 2 + number)
            z = _read(instrument, true[number][1], truth, x, u, normals)
            if not np.isnan(z).all():
                index += 1
                yield Entry(index, Reading(target.sensor, z, target.name), truth, t=t)


def _steered(course: Course, tick: int, wanted: Array, truth: Array) -> tuple[Array, Array]:
    """Speed and turn rate : (…) each; where the driver holds the robot to its way, back towards the wanted pose."""
    speed, turn_rate = course.speed[tick], course.turn_rate[tick]
    if not course.held:
        return speed, turn_rate
    dx, dy = wanted[0] - truth[..., 0], wanted[1] - truth[..., 1]
    c, s = np.cos(truth[..., 2]), np.sin(truth[..., 2])
    ahead, aside, turn = c * dx + s * dy, c * dy - s * dx, wrap(wanted[2] - truth[..., 2])
    return speed + ALONG * ahead, turn_rate + np.sign(speed) * ACROSS * aside + AROUND * turn


def _moved(pose: Array, distance: Array, turn: Array, velocity: Array, dt: float) -> Tick:
    """Drive along an arc, by the mid-point rule."""
    middle = pose[..., 2] + turn / 2
    step = distance[..., None] * np.stack([np.cos(middle), np.sin(middle)], axis=-1)
    after = np.concatenate([pose[..., :2] + step, wrap(pose[..., 2] + turn)[..., None]], axis=-1)
    return Tick(pose, after, distance, turn, velocity, step / dt, dt)


def _disturbed(pose: Array, Q: Array | float, normals: Sequence[Array]) -> Array:
    """The pose after the process noise, where the motion has any."""
    if not np.any(Q):
        return pose
    disturbed: Array = pose + _noise(np.asarray(Q), normals)
    disturbed[..., 2] = wrap(disturbed[..., 2])
    return disturbed


def _noise(covariance: Array, normals: Sequence[Array]) -> Array:
    """Noise of a covariance (…, m, m) : (…, m). Only four numbers are drawn at a time: no model has more noisy ones."""
    n = np.zeros((*np.shape(normals[0]), covariance.shape[-1]))
    drawn = min(len(normals), n.shape[-1])
    n[..., :drawn] = np.stack(normals[:drawn], axis=-1)
    noise: Array = np.matvec(square_root(covariance), n)
    return noise


def _due(rate: float, tick: int, dt: float) -> bool:
    """Whether an instrument is read at the end of a tick."""
    return math.floor((tick + 1) * dt * rate + SOON) > math.floor(tick * dt * rate + SOON)


def _read(instrument: Instrument, target: Target, truth: Array, x: Array, u: Array, normals: Sequence[Array]) -> Array:
    """The reading of a target from a true pose and its state x : (…, k), nan where the target is not in view."""
    h, _, R = target.sensor.linearize(x)
    if isinstance(instrument, Pylon):  # the lidar's own noise, then turned by the yaw as it was measured
        turn = wrap(u[..., 2] - truth[..., 2])
        c, s = np.cos(turn), np.sin(turn)
        h = np.stack([c * h[..., 0] - s * h[..., 1], s * h[..., 0] + c * h[..., 1]], axis=-1)
        R = np.eye(2) * instrument.sigma**2
    z = np.where(instrument.sees(target, truth)[..., None], h + _noise(np.nan_to_num(R), normals), np.nan)
    for i in angles(target.sensor.outputs):
        z[..., i] = wrap(z[..., i])
    return z
