"""Runs of the classroom side by side, watched by ekf, huber or pdaf, from their draws to what is
counted.

The text makes a Step of arrays of every command, and judges it. Here a block is the state of its
runs and what is counted of them, and a command takes three or four calls of compiled code. The
draws are the text's, to the last bit. What is rare and needs care, a beam through a corner, a P
that is nearly singular, is done by the text, for those runs alone.
"""

import math

import numpy as np

from ekfsim.commands import Kidnap, Move, Say, Sense, expand
from ekfsim.diagnostics.nees import OUTSIDE, RANK, ROUNDING, squared_mahalanobis
from ekfsim.diagnostics.verdict import LOST
from ekfsim.fast.compiled import beams, judging, steps
from ekfsim.fast.compiled.models import normals_met
from ekfsim.fast.many.nees import CLEAR
from ekfsim.filters.arithmetic import tolerances
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.cures import huber, pdaf
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.ellipse import cone_factor, radius_factor
from ekfsim.models.sensors.laser import ALONG
from ekfsim.raycast.ground import CLEARANCE
from ekfsim.raycast.rules import REACH, TIE
from ekfsim.raycast.searches.round_before import round_before
from ekfsim.raycast.walls import Hit, Walls
from ekfsim.scene import Scene
from ekfsim.simulation.draws import Draws, true_start
from ekfsim.study.block import Readings, Watched, length_of, steps_told
from ekfsim.study.counting import COVERAGE, Ends, Judged, by_rank
from ekfsim.study.running.whole_runs import is_whole
from ekfsim.study.tally import AtSteps

UPPER = np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2])  # P's upper half: rows, columns
WHOLE = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])  # and where each entry of P stands in it
ASKED = 0.5, 0.95, LOST  # the quantiles of χ² that a step's NEES is held against


def watched(scene: Scene, first: int, runs: int) -> Watched | None:
    """The runs first … first + runs − 1, each told apart at its end."""
    if not is_whole(scene):
        return None
    block = Block(scene, np.arange(first, first + runs), steps_told(length_of(scene)))
    block.judge()
    for command in expand(scene.commands):
        match command:
            case Move():
                block.move(command)
            case Sense(angle):
                block.sense(angle)
            case Kidnap(x, y, theta):
                block.truth[:] = np.array([[x], [y], [wrap(np.asarray(theta))]])
        block.judge(changed=not isinstance(command, Say))
    return block.watched()


def trust(scene: Scene) -> tuple[float, float]:
    """Which filter it is, in the numbers of `trusting.weighed`."""
    own, limit, ln_clutter = scene.tuning, math.inf, -math.inf
    if scene.filter == "huber":
        limit = huber.limit(own.huber, 1)
    if scene.filter == "pdaf":
        ln_clutter = float(pdaf.ln_clutter(own.clutter, own.clutter_density, 1))
    return limit, ln_clutter


class Block:
    """N runs side by side: truth, x : (3, N), P : (6, N), the upper half of each, row after row."""

    def __init__(self, scene: Scene, numbers: Integers, told: Integers) -> None:
        N = len(numbers)
        self.world, self.numbers = scene.world, numbers
        self.draws, self.drawn = Draws(scene.seed, numbers), 0
        self.truth = np.ascontiguousarray(true_start(scene.world, self.draws).T)
        start, sigma = scene.world.told.start, scene.world.told.sigma
        self.x = np.repeat(start[:, None].astype(float), N, axis=1)
        self.P = np.repeat(np.diag(sigma**2)[UPPER][:, None], N, axis=1)
        gate = math.inf if scene.gate is None else quantile(scene.gate, 1)
        self.refusal = gate, *trust(scene)
        self.nis, self.nis_dof, self.readings = np.zeros(N), np.zeros(N, np.int64), 0
        self.e, self.nees = np.empty((3, N)), np.empty(N)
        self.rank, self.impossible = np.empty(N, np.int64), np.empty(N, bool)
        self.lost_from, self.some = np.full(N, -1), np.empty(N, np.int64)
        self.stand = np.empty((4, N), bool)  # inside, drawn, in_cone and unsure of `Ends`
        self.told, self.step = told, -1
        self.rows, self.row = list[Array](), np.empty(len(AtSteps._fields))
        self.quantiles = np.array([by_rank(probability) for probability in ASKED])
        self.factors = radius_factor(COVERAGE) ** 2, cone_factor(COVERAGE) ** 2

    def move(self, move: Move) -> None:
        """The truth goes on, x and P by what the odometry tells of it."""
        self.drawn += 1
        noise, faults = self.world.noise, self.world.faults
        by_way, by_turn, odometry_way, odometry_turn = self.draws.normals(self.drawn)
        wheels = move.distance + noise.execution_distance * abs(move.distance) * by_way
        way = self._until_wall((1 - move.slip) * wheels)
        turn = move.angle + noise.execution_angle * abs(move.angle) * by_turn
        turned = way / (1 - move.slip) if move.slip < 1 else wheels
        d = faults.odometry_distance_scale * turned
        d = d + noise.odometry_distance * abs(turned) * odometry_way
        a = faults.odometry_angle_scale * turn + noise.odometry_angle * abs(turn) * odometry_turn
        told = self.world.told.noise
        ratios = told.odometry_distance, told.odometry_angle
        steps.move(self.truth, self.x, self.P, way, turn, d, a, *ratios)

    def _until_wall(self, way: Array) -> Array:
        """The ways (N,), cut short of the first wall."""
        walls, some = self.world.map.walls, self.some
        heading = np.where(way < 0, self.truth[2] + np.pi, self.truth[2])
        if walls.round is not None:
            free = walls.cast(self.truth[:2].T, heading).range - CLEARANCE
            return np.copysign(np.fmin(np.maximum(free, 0.0), np.abs(way)), way)
        if walls.grid is None:
            return way
        tolerances = CLEARANCE, walls.grid.size, TIE, 4 * REACH
        ends = walls.segments.reshape(-1, 4)
        if left := beams.stop(ends, self.truth, heading, way, *tolerances, some):
            some = some[:left]
            free = walls.cast(self.truth[:2, some].T, heading[some]).range - CLEARANCE
            cut = np.fmin(np.maximum(free, 0.0), np.abs(way[some]))
            way[some] = np.copysign(cut, way[some])
        return way

    def sense(self, bearing: float) -> None:
        """A reading of the true wall revises x and P."""
        self.drawn += 1
        noise, faults = self.world.noise, self.world.faults
        r, _, _ = cast(self.world.map.walls, self.truth, bearing)
        if faults.short_returns > 0:
            normals, (decides, u) = self.draws.normals_and_uniforms(self.drawn)
            r = np.where(decides < faults.short_returns, u * r, r)
        else:
            normals = self.draws.normals(self.drawn)
        z = faults.range_scale * r + faults.range_bias + noise.range * r * normals[0]
        walls = self.world.told.map.walls
        h, wall, way = cast(walls, self.x, bearing)
        n, wall = normals_met(walls, Hit(h, wall), self.x[:2], self.x[2] + bearing)
        self.readings += steps.read(
            self.x, self.P, np.maximum(z, 0.0), h, wall, way, n,
            self.world.told.noise.range, ALONG, tolerances.SHARP, tolerances.ROUNDING,
            *self.refusal, self.nis, self.nis_dof,
        )  # fmt: skip

    def judge(self, changed: bool = True) -> None:
        """Hold the beliefs against the truth after a step, and count where it is one to tell of."""
        self.step += 1
        told = bool(self.step == self.told[len(self.rows)])
        if changed:
            left = judging.judge(
                self.x, self.P, self.truth, ROUNDING, CLEAR, RANK, OUTSIDE,
                self.e, self.nees, self.rank, self.impossible, self.some,
            )  # fmt: skip
            if left:
                self._judge_as_written(self.some[:left])
        if changed or told:
            judging.count(
                self.e, self.P, self.nees, self.rank, self.impossible, self.step, told,
                self.quantiles, ROUNDING, RANK, OUTSIDE, *self.factors, self.lost_from, self.row,
                *self.stand,
            )  # fmt: skip
        if told:
            self.rows.append(self.row.copy())

    def _judge_as_written(self, some: Integers) -> None:
        """The NEES of these runs by the text. some : (m,)"""
        P = self.P[:, some][WHOLE].transpose(2, 0, 1)
        value, self.rank[some], impossible = squared_mahalanobis(self.e[:, some].T, P)
        self.impossible[some] |= impossible
        self.nees[some] = np.where(self.impossible[some], np.nan, value)

    def watched(self) -> Watched:
        """What is known of the runs so far."""
        return Watched(
            numbers=self.numbers,
            told=self.told,
            lost_from=self.lost_from,
            readings=Readings(self.nis, self.nis_dof, self.readings),
            ends=Ends(Judged(self.nees, self.rank, self.impossible), self.e.T, *self.stand),
            step=self.step,
            at=tuple(map(AtSteps._make, self.rows)),
            times=(math.nan,) * len(self.rows),
        )


def cast(walls: Walls, place: Array, bearing: float) -> tuple[Array, Integers, Array]:
    """Ranges (N,), walls (N,) and directions (2, N) of beams from many poses (3, N)."""
    N = place.shape[1]
    ranges, wall, way = np.full(N, np.nan), np.full(N, -1), np.empty((2, N))
    if walls.grid is not None:
        tolerances = walls.grid.size, TIE, 4 * REACH
        ends = walls.segments.reshape(-1, 4)
        if beams.cast(ends, place, place[2] + bearing, *tolerances, ranges, wall, way):
            some = np.flatnonzero(wall == beams.DOUBT)
            hit = walls.cast(place[:2, some].T, place[2, some] + bearing)
            ranges[some], wall[some] = hit.range, hit.wall
    if walls.round is not None:
        ranges, wall = round_before(walls.round, (ranges, wall), np.vstack([place[:2], way]))
    return ranges, wall, way
