"""World + commands + draws → Entries: a log being written.

The truth moves here and nowhere else; what the filter is given (odometry, ranges, its own map) leaves in the Entry.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.models.laser import Laser
from ekfsim.models.move_turn import MoveTurn
from ekfsim.records import Control, Entry, Kidnap, Move, Reading, Say, Sense, expand
from ekfsim.scene import Scene
from ekfsim.world import World

BLOCK = 1024  # runs that share a generator
CLEARANCE = 1e-3  # m that a robot stops short of a wall


class Draws:
    """The random numbers of some runs: a function of (seed, index, run) alone.

    Draw i of the runs 1024·b … 1024·b + 1023 comes from Generator(PCG64(SeedSequence([seed, i, b]))): normals of shape
    (1024, 4) first, then uniforms of shape (1024, 2). So another ratio, filter or gate changes no draw, and any run of
    a study can be played alone.
    """

    def __init__(self, seed: int, runs: Integers) -> None:
        self._seed = seed
        self._runs = runs

    def normals(self, i: int) -> Sequence[Array]:
        """The four standard normals of draw i : (…) each"""
        return self._draw(i, uniforms=False)[0]

    def normals_and_uniforms(self, i: int) -> tuple[Sequence[Array], Sequence[Array]]:
        """The four standard normals and the two uniforms in [0, 1) of draw i : (…) each"""
        return self._draw(i, uniforms=True)

    def _draw(self, i: int, uniforms: bool) -> tuple[Sequence[Array], Sequence[Array]]:
        if self._runs.ndim == 0:
            return self._draw_one(i, *divmod(int(self._runs), BLOCK), uniforms)
        normals_of, uniforms_of = np.empty((4, *self._runs.shape)), np.empty((2, *self._runs.shape))
        blocks = self._runs // BLOCK
        for b in np.unique(blocks):
            here = blocks == b
            rows = self._runs[here] % BLOCK
            generator = self._generator(i, int(b))
            normals_of[:, here] = generator.standard_normal((BLOCK, 4))[rows].T
            if uniforms:
                uniforms_of[:, here] = generator.random((BLOCK, 2))[rows].T
        return tuple(normals_of), tuple(uniforms_of)

    def _draw_one(self, i: int, b: int, row: int, uniforms: bool) -> tuple[Sequence[Array], Sequence[Array]]:
        """The same for one run: of the normals no more than is needed, for the uniforms stand behind all of them."""
        generator = self._generator(i, b)
        normals = generator.standard_normal((BLOCK if uniforms else row + 1, 4))[row].tolist()
        return normals, generator.random((BLOCK, 2))[row].tolist() if uniforms else ()

    def _generator(self, i: int, b: int) -> np.random.Generator:
        return np.random.Generator(np.random.PCG64(np.random.SeedSequence([self._seed, i, b])))


def simulate(scene: Scene, runs: Integers | None = None) -> Iterator[Entry]:
    """The log of the scene's run, or of N runs side by side. runs : (N,) numbers from 0

    Entry 0 is the start; then one for each expanded command.
    """
    world, numbers = scene.world, np.asarray(scene.run if runs is None else runs, dtype=np.int64)
    draws, drawn = Draws(scene.seed, numbers), 0
    motion = MoveTurn(world.told.noise.odometry_distance, world.told.noise.odometry_angle)
    truth = world.start + world.start_sigma * np.stack(draws.normals(0)[:3], axis=-1)
    truth[..., 2] = wrap(truth[..., 2])
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


def _drive(world: World, pose: Array, move: Move, normals: Sequence[Array]) -> tuple[Array, Array, Integers]:
    """Drive, then turn: the true pose after it (…, 3), the odometry (…, 2), and the wall that was bumped into (…)."""
    noise, faults = world.noise, world.faults
    execution_distance, execution_angle, odometry_distance, odometry_angle = normals
    wheels = move.distance + noise.execution_distance * abs(move.distance) * execution_distance
    way, bump = _until_wall(world, pose, (1 - move.slip) * wheels)
    turn = move.angle + noise.execution_angle * abs(move.angle) * execution_angle
    turned = way / (1 - move.slip) if move.slip < 1 else wheels  # what the wheels did of it
    d = faults.odometry_distance_scale * turned + noise.odometry_distance * abs(turned) * odometry_distance
    a = faults.odometry_angle_scale * turn + noise.odometry_angle * abs(turn) * odometry_angle
    return MoveTurn(0, 0).f(pose, _paired(way, turn)), _paired(d, a), bump


def _until_wall(world: World, pose: Array, way: Array) -> tuple[Array, Integers]:
    """The way, cut 1 mm short of the first wall (0 if that is nearer), and that wall, −1 where none is in the way."""
    if pose.ndim == 1:
        return _until_wall_one(world, pose, float(way))
    heading = np.where(way < 0, pose[..., 2] + np.pi, pose[..., 2])
    hit = world.map.walls.cast(pose[..., :2], heading)
    free = np.maximum(hit.range - CLEARANCE, 0.0)
    bumped = np.abs(way) > free  # never where the range is nan
    return np.where(bumped, np.copysign(free, way), way), np.where(bumped, hit.wall, -1)


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
    return np.array([d, a]) if np.ndim(d) == 0 else np.stack(np.broadcast_arrays(d, a), axis=-1)
