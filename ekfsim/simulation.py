"""World + commands + draws → Entries: a log being written.

The truth moves here and nowhere else; what the filter is given (odometry, ranges, its own map) leaves in the Entry.
"""

import math
from collections.abc import Iterator

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

    def normals(self, i: int) -> Array:
        """Standard normals of draw i : (…, 4)"""
        return self._draw(i, uniforms=False)[0]

    def uniforms(self, i: int) -> Array:
        """Uniforms in [0, 1) of draw i : (…, 2)"""
        return self._draw(i, uniforms=True)[1]

    def _draw(self, i: int, uniforms: bool) -> tuple[Array, Array]:
        if self._runs.ndim == 0:
            return self._draw_one(i, *divmod(int(self._runs), BLOCK), uniforms)
        normals_of, uniforms_of = np.empty((*self._runs.shape, 4)), np.empty((*self._runs.shape, 2))
        blocks = self._runs // BLOCK
        for b in np.unique(blocks):
            here = blocks == b
            rows = self._runs[here] % BLOCK
            generator = self._generator(i, int(b))
            normals_of[here] = generator.standard_normal((BLOCK, 4))[rows]
            if uniforms:
                uniforms_of[here] = generator.random((BLOCK, 2))[rows]
        return normals_of, uniforms_of

    def _draw_one(self, i: int, b: int, row: int, uniforms: bool) -> tuple[Array, Array]:
        """The same for one run: of the normals no more than is needed, for the uniforms stand behind all of them."""
        generator = self._generator(i, b)
        normals = generator.standard_normal((BLOCK if uniforms else row + 1, 4))[row]
        return normals, generator.random((BLOCK, 2))[row] if uniforms else np.empty(2)

    def _generator(self, i: int, b: int) -> np.random.Generator:
        return np.random.Generator(np.random.PCG64(np.random.SeedSequence([self._seed, i, b])))


def simulate(scene: Scene, runs: Integers | None = None) -> Iterator[Entry]:
    """The log of the scene's run, or of N runs side by side. runs : (N,) numbers from 0

    Entry 0 is the start; then one for each expanded command.
    """
    world, numbers = scene.world, np.asarray(scene.run if runs is None else runs, dtype=np.int64)
    draws, drawn = Draws(scene.seed, numbers), 0
    motion = MoveTurn(world.told.noise.odometry_distance, world.told.noise.odometry_angle)
    truth = world.start + world.start_sigma * draws.normals(0)[..., :3]
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


def _drive(world: World, pose: Array, move: Move, normal: Array) -> tuple[Array, Array, Integers]:
    """Drive, then turn: the true pose after it (…, 3), the odometry (…, 2), and the wall that was bumped into (…)."""
    noise, faults = world.noise, world.faults
    wheels = move.distance + noise.execution_distance * abs(move.distance) * normal[..., 0]
    way, bump = _until_wall(world, pose, (1 - move.slip) * wheels)
    turn = move.angle + noise.execution_angle * abs(move.angle) * normal[..., 1]
    turned = way / (1 - move.slip) if move.slip < 1 else wheels  # what the wheels did of it
    d = faults.odometry_distance_scale * turned + noise.odometry_distance * np.abs(turned) * normal[..., 2]
    a = faults.odometry_angle_scale * turn + noise.odometry_angle * np.abs(turn) * normal[..., 3]
    after = MoveTurn(0, 0).f(pose, np.stack([way, turn], axis=-1))
    return after, np.stack([d, a], axis=-1), bump


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
    r = world.map.walls.cast(pose[..., :2], pose[..., 2] + bearing).range
    if world.faults.short_returns > 0:
        uniform = draws.uniforms(i)
        r = np.where(uniform[..., 0] < world.faults.short_returns, uniform[..., 1] * r, r)
    noise = world.noise.range * r * draws.normals(i)[..., 0]
    return np.maximum(world.faults.range_scale * r + world.faults.range_bias + noise, 0.0)[..., None]
