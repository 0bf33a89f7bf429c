"""The classroom's robot obeys commands: world + commands + draws → Entries."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ekfsim.commands import Expanded, Kidnap, Move, Say, Sense, expand
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.soa import soa_zeros
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.ground import CLEARANCE
from ekfsim.raycast.walls import Walls
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.simulation.draws import Draws, true_start
from ekfsim.twins import twinned
from ekfsim.world import World


def obey(scene: Scene, draws: Draws) -> Iterator[Entry]:
    """The log of a robot that obeys: the start, then an entry for each expanded command."""
    yield from obeyed(scene.world, draws, expand(scene.commands))


def obeyed(
    world: World,
    draws: Draws,
    commands: Iterable[Expanded],
    before: Entry | None = None,
    drawn: int = 0,
) -> Iterator[Entry]:
    """An entry for each command, behind that of the start; or behind an entry that there was
    already, before which so many numbers were drawn.
    """
    motion = MoveTurn(world.told.noise.odometry_distance, world.told.noise.odometry_angle)
    if before is None:
        before = Entry(0, None, true_start(world, draws))
        yield before
    assert before.truth is not None
    truth = before.truth
    for index, command in enumerate(commands, start=before.index + 1):
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
    way, bump = until_wall(world.map.walls, pose, (1 - move.slip) * wheels)
    turn = move.angle + noise.execution_angle * abs(move.angle) * execution_angle
    turned = way / (1 - move.slip) if move.slip < 1 else wheels  # what the wheels did of it
    d = (
        faults.odometry_distance_scale * turned
        + noise.odometry_distance * abs(turned) * odometry_distance
    )
    a = faults.odometry_angle_scale * turn + noise.odometry_angle * abs(turn) * odometry_angle
    return MoveTurn(0, 0).f(pose, paired(way, turn)), paired(d, a), bump


@twinned
def until_wall(walls: Walls, pose: Array, way: Array) -> tuple[Array, Integers]:
    """The way (…) m, cut 1 mm short of the first wall (0 if that is nearer), and that wall, −1
    where none is in the way.
    """
    θ = np.where(way < 0, pose[..., 2] + np.pi, pose[..., 2])
    hit = walls.cast(pose[..., :2], θ)
    free = np.maximum(hit.range - CLEARANCE, 0.0)
    bumped = np.abs(way) > free  # never where the range is nan
    return np.where(bumped, np.copysign(free, way), way), np.where(bumped, hit.wall, -1)


def _measure(world: World, pose: Array, bearing: float, draws: Draws, i: int) -> Array:
    """The laser's reading along a bearing : (…, 1) m, nan where there is no echo."""
    r = world.map.walls.cast(pose[..., :2], pose[..., 2] + bearing).range
    if world.faults.short_returns > 0:
        normals, (decides, u) = draws.normals_and_uniforms(i)
        r = np.where(decides < world.faults.short_returns, u * r, r)
    else:
        normals = draws.normals(i)
    z = world.faults.range_scale * r + world.faults.range_bias + world.noise.range * r * normals[0]
    return np.maximum(z, 0.0)[..., None]


@twinned
def paired(d: Array, a: Array) -> Array:
    """(d, a) as a motion input : (…, 2)"""
    u = soa_zeros(np.broadcast_shapes(np.shape(d), np.shape(a)), 2)
    u[..., 0], u[..., 1] = d, a
    return u
