"""The classroom's robot obeys commands: world + commands + draws → Entries."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ekfsim.commands import Kidnap, Move, Say, Sense, expand
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.soa import front, lanes
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.ground import CLEARANCE
from ekfsim.raycast.walls import Walls
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.simulation.draws import Draws, true_start
from ekfsim.world import World

FEW = 32  # walls near any of the robots that are sooner looked at one by one


def obey(scene: Scene, draws: Draws) -> Iterator[Entry]:
    """The log of a robot that obeys: the start, then an entry for each expanded command."""
    world, drawn = scene.world, 0
    motion = MoveTurn(world.told.noise.odometry_distance, world.told.noise.odometry_angle)
    truth = true_start(world, draws)
    yield Entry(0, None, truth)
    for index, command in enumerate(expand(scene.commands), start=1):
        match command:
            case Move():
                drawn += 1
                truth, u, bump = _drive(world, truth, command, draws.normals(drawn))
                yield Entry(index, Control(motion, u), truth, command, bump)
            case Sense(angle):
                drawn += 1
                z = _measure(world, truth, angle, draws, drawn)
                laser = Laser(world.told.map.walls, angle, world.told.noise.range)
                yield Entry(index, Reading(laser, z), truth, command)
            case Kidnap(x, y, theta):
                truth = np.broadcast_to(np.array([x, y, wrap(np.asarray(theta))]), truth.shape)
                yield Entry(index, None, truth, command)
            case Say():
                yield Entry(index, None, truth, command)


def _drive(
    world: World, pose: Array, move: Move, normals: Sequence[Array]
) -> tuple[Array, Array, Integers]:
    """Drive, then turn: the true pose after it (…, 3), the odometry (…, 2), and the wall that was
    bumped into (…).
    """
    noise, faults = world.noise, world.faults
    execution_distance, execution_angle, odometry_distance, odometry_angle = normals
    wheels = move.distance + noise.execution_distance * abs(move.distance) * execution_distance
    way, bump = _until_wall(world, pose, (1 - move.slip) * wheels)
    turn = move.angle + noise.execution_angle * abs(move.angle) * execution_angle
    turned = way / (1 - move.slip) if move.slip < 1 else wheels  # what the wheels did of it
    d = (
        faults.odometry_distance_scale * turned
        + noise.odometry_distance * abs(turned) * odometry_distance
    )
    a = faults.odometry_angle_scale * turn + noise.odometry_angle * abs(turn) * odometry_angle
    return MoveTurn(0, 0).f(pose, _paired(way, turn)), _paired(d, a), bump


def _until_wall(world: World, pose: Array, way: Array) -> tuple[Array, Integers]:
    """The way, cut 1 mm short of the first wall (0 if that is nearer), and that wall, −1 where none
    is in the way.
    """
    if pose.ndim == 1:
        return _until_wall_one(world, pose, float(way))
    some = _may_bump(world.map.walls, pose, way)
    if not some.size:
        return way, np.full(way.shape, -1)
    x, some_way = pose[some], way[some]
    heading = np.where(some_way < 0, x[..., 2] + np.pi, x[..., 2])
    hit = world.map.walls.cast(x[..., :2], heading)
    free = np.maximum(hit.range - CLEARANCE, 0.0)
    bumped = np.abs(some_way) > free  # never where the range is nan
    cut, walls = way.copy(), np.full(way.shape, -1)
    cut[some] = np.where(bumped, np.copysign(free, some_way), some_way)
    walls[some] = np.where(bumped, hit.wall, -1)
    return cut, walls


def _may_bump(walls: Walls, pose: Array, way: Array) -> Integers:
    """Which of N runs may meet a wall on their way or come near one: few in a study, where all go
    much the same way.
    """
    reach, place = np.abs(way) + 2 * CLEARANCE, front(pose, 1)[:2]
    far = float(reach.max())
    near = walls.near(place.min(axis=1) - far, place.max(axis=1) + far)
    if not 0 < len(near) <= FEW:
        return np.arange(len(way) if len(near) else 0)
    ends = walls.segments[near]
    first, last = ends.min(axis=1)[..., None], ends.max(axis=1)[..., None]
    return np.flatnonzero(
        ((first <= place + reach) & (last >= place - reach)).all(axis=1).any(axis=0)
    )


def _until_wall_one(world: World, pose: Array, way: float) -> tuple[Array, Integers]:
    """The same for one robot, without the cost of arrays."""
    x, y, θ = pose.tolist()
    r, wall = world.map.walls.first(x, y, θ + math.pi if way < 0 else θ)
    free = max(r - CLEARANCE, 0.0) if wall >= 0 else math.inf
    bumped = abs(way) > free
    return np.array(math.copysign(free, way) if bumped else way), np.array(wall if bumped else -1)


def _measure(world: World, pose: Array, bearing: float, draws: Draws, i: int) -> Array:
    """The laser's reading along a bearing : (…, 1) m, nan where there is no echo."""
    if pose.ndim == 1:
        x, y, θ = pose.tolist()
        r = np.array(world.map.walls.first(x, y, θ + bearing)[0])
    else:
        r = world.map.walls.cast(pose[..., :2], pose[..., 2] + bearing).range
    if world.faults.short_returns > 0:
        normals, (decides, u) = draws.normals_and_uniforms(i)
        r = np.where(decides < world.faults.short_returns, u * r, r)
    else:
        normals = draws.normals(i)
    z = world.faults.range_scale * r + world.faults.range_bias + world.noise.range * r * normals[0]
    return np.maximum(z, 0.0)[..., None]


def _paired(d: Array, a: Array) -> Array:
    """(d, a) as a motion input : (…, 2)"""
    if np.ndim(d) == 0:
        return np.array([d, a])
    u = lanes(np.broadcast_shapes(np.shape(d), np.shape(a)), 2)
    u[..., 0], u[..., 1] = d, a
    return u
