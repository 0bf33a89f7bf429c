"""1 000 runs side by side, 100 predictions and updates each, against filterpy in a Python loop over
the runs.

Without rays both are handed the same odometry, readings and truth: a range of a landmark after
every move; both judge every prediction and every update by its NEES. Ours makes a Step of each,
filterpy keeps nothing but a sum. With rays both play the classroom's game among 400 walls: draw,
drive, measure, predict, update, judge. filterpy's ranges come from shapely's STRtree, its Jacobian
from the wall that was hit; it does not look whether a wall stands in the robot's way, which ours
does.

The peers are timed on a part of the runs: a loop over all of them takes as much longer. Ours is
timed with NumPy, and with compiled code where the extra `fast` is installed: then with rays it is
the block of a study, tally included, which makes no Steps.

python benchmarks/study.py [--quick]
"""

import argparse
import math
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import shapely
from timing import WAYS, Task, optional, ratios

from ekfsim import twins
from ekfsim.commands import Move, Repeat, Sense
from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.floor import Map, Obstacle
from ekfsim.geometry import Array
from ekfsim.localization import localize, play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.landmarks import RangeOnly
from ekfsim.records import Control, Entry, Log, Reading, Step
from ekfsim.scene import Scene
from ekfsim.study.block import run_block, watched
from ekfsim.world import Noise, Told, World

RUNS, STEPS = 1000, 100
NOISE = Noise(0.01, 0.01, 0.02, 0.02, 0.01)
BEACONS = ((5.0, 40.0), (45.0, 5.0), (42.0, 44.0), (6.0, 4.0), (25.0, 48.0))
BEACON_SIGMA = 0.1  # m
FIRST = Gaussian(np.array([25.0, 25.0, 0.0]), np.diag([0.1, 0.1, 0.05]) ** 2)
LANE = 10.0  # m from the middle of one pillar to the next
GATE = 0.997  # a beam to another wall than the one predicted is refused by both
SIDE = 2 * LANE  # m of the square lap between them


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    quick = parser.parse_args().quick
    if optional("filterpy") is None:
        return
    log, scene, some = recorded(), among_pillars(), list(range(10 if quick else 25))
    trees = Trees(scene.world.map)
    for name, way in WAYS.items():
        if way == "compiled" and optional("numba") is None:
            continue
        twins.take(way)
        *_, last = localize(log.entries, EKF(), log.first)
        difference = max(
            np.abs(last.posterior.mean[run] - filtered(log, run)[0]).max() for run in some
        )
        print(f"{name}, no rays; largest difference from filterpy {difference:.1e}")
        compare(
            lambda: every(localize(log.entries, EKF(), log.first)),
            lambda: filter_all(log, some),
            some,
            quick,
        )
        ours = np.median(watched(scene, 0, RUNS).ends.nees.value)
        theirs = np.median([played(scene, trees, run)[1] for run in range(100)])
        print(
            f"{name}, {len(scene.world.map.walls.segments)} walls; median NEES at the end "
            f"{ours:.1f} and {theirs:.1f}"
        )
        study = block if way == "compiled" else steps
        compare(partial(study, scene), partial(play_all, scene, trees, some), some, quick)


def block(scene: Scene) -> int:
    """What a study makes of all runs, tally included: of Steps there are none where it is
    compiled.
    """
    return run_block(scene, 0, RUNS).runs


def steps(scene: Scene) -> int:
    """Every Step of all runs."""
    return every(play(scene, np.arange(RUNS)))


def compare(ours: Task, peer: Task, some: list[int], quick: bool) -> None:
    """Print how a study compares with a loop over all its runs, of which the peer does some."""
    loop = "filterpy in a Python loop"
    for ratio in ratios(ours, {loop: peer}, 3 if quick else 7, calls={loop: RUNS / len(some)}):
        print(ratio)


def every(steps: Iterator[Step]) -> int:
    """Go through a study as one that reduces it does; how many steps that is."""
    return sum(1 for _ in steps)


def recorded() -> Log:
    """The log of N robots side by side that move and turn among beacons."""
    random = np.random.default_rng(0)
    motion, entries = MoveTurn(NOISE.odometry_distance, NOISE.odometry_angle), []
    truth = FIRST.mean + random.standard_normal((RUNS, 3)) * np.sqrt(np.diagonal(FIRST.covariance))
    entries.append(Entry(0, None, truth))
    for k in range(STEPS):
        u = np.array([1.0, 0.08])
        truth = motion.f(
            truth, u * (1 + NOISE.odometry_distance * random.standard_normal((RUNS, 2)))
        )
        entries.append(
            Entry(2 * k + 1, Control(motion, np.broadcast_to(u, (RUNS, 2)).copy()), truth)
        )
        sensor = RangeOnly(*BEACONS[k % len(BEACONS)], BEACON_SIGMA)
        z = sensor.h(truth) + BEACON_SIGMA * random.standard_normal((RUNS, 1))
        entries.append(Entry(2 * k + 2, Reading(sensor, z), truth))
    return Log(
        tuple(entries),
        Gaussian(np.tile(FIRST.mean, (RUNS, 1)), np.tile(FIRST.covariance, (RUNS, 1, 1))),
    )


def among_pillars() -> Scene:
    """99 square pillars in a hall of 100 m by 100 m, 400 walls, and a robot that drives a square in
    the lanes.
    """
    random = np.random.default_rng(5)
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    middles = [(LANE * (i + 0.5), LANE * (j + 0.5)) for i in range(10) for j in range(10)][1:]
    obstacles = tuple(
        Obstacle(
            f"pillar {n}",
            np.array(middle) + random.uniform(-1, 1, 2) + corners * random.uniform(1, 2.5),
        )
        for n, middle in enumerate(middles)
    )
    room = Map(np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]]), obstacles)
    start, sigma = np.array([4 * LANE, 4 * LANE, 0.0]), np.array([0.05, 0.05, 0.01])
    world = World("pillars", room, start, sigma, NOISE, Told(start, sigma, NOISE, room))
    looks = [math.radians(angle) for angle in (70, -75, 180, 105, -100)]
    side = tuple(
        command
        for k in range(int(SIDE))
        for command in (
            Move(1.0, math.pi / 2 if k == SIDE - 1 else 0.0),
            Sense(looks[k % len(looks)]),
        )
    )
    return Scene(world, (Repeat(STEPS // int(SIDE), side),), gate=GATE)


def robot() -> Any:
    """filterpy's extended Kalman filter for a robot that moves and turns."""
    from filterpy.kalman import ExtendedKalmanFilter

    ratio_d, ratio_a = NOISE.odometry_distance**2, NOISE.odometry_angle**2

    class Robot(ExtendedKalmanFilter):  # type: ignore[misc]
        def predict_x(self, u: Any = 0) -> None:
            d, a = u
            x, y, θ = self.x.tolist()
            c, s = math.cos(θ), math.sin(θ)
            self.x = np.array([x + d * c, y + d * s, wrap_one(θ + a)])
            self.F = np.array([[1.0, 0.0, -d * s], [0.0, 1.0, d * c], [0.0, 0.0, 1.0]])
            D = ratio_d * d * d
            self.Q = np.array(
                [
                    [D * c * c, D * c * s, 0.0],
                    [D * c * s, D * s * s, 0.0],
                    [0.0, 0.0, ratio_a * a * a],
                ]
            )

    return Robot(dim_x=3, dim_z=1)


def nees_one(x: Array, P: Array, truth: Array) -> float:
    """eᵀ P⁻¹ e"""
    e = x - truth
    e[2] = wrap_one(float(e[2]))
    return float(e @ np.linalg.solve(P, e))


def filtered(log: Log, run: int) -> tuple[Array, float]:
    """One run of the log by filterpy: the last estimate and the sum of its NEES."""
    one, total = robot(), 0.0
    one.x, one.P = log.first.mean[run].copy(), log.first.covariance[run].copy()
    one.R = np.array([[BEACON_SIGMA**2]])
    entries = iter(log.entries[1:])
    for move, reading in zip(entries, entries, strict=True):
        one.predict(move.given.u[run].tolist())
        total += nees_one(one.x, one.P, move.truth[run])
        x_b, y_b = reading.given.sensor.x, reading.given.sensor.y

        def h(x: Array, x_b: float = x_b, y_b: float = y_b) -> Array:
            px, py, _ = x.tolist()
            return np.array([math.hypot(x_b - px, y_b - py)])

        def H(x: Array, x_b: float = x_b, y_b: float = y_b) -> Array:
            px, py, _ = x.tolist()
            r = math.hypot(x_b - px, y_b - py)
            return np.array([[(px - x_b) / r, (py - y_b) / r, 0.0]])

        one.update(reading.given.z[run], H, h)
        total += nees_one(one.x, one.P, reading.truth[run])
    return one.x, total


def filter_all(log: Log, runs: list[int]) -> float:
    return sum(filtered(log, run)[1] for run in runs)


class Trees:
    """Ranges from shapely's STRtree over the walls, one by one."""

    def __init__(self, plan: Map, reach: float = 150.0) -> None:
        self.reach, self.walls = reach, plan.walls
        self.lines = [shapely.LineString(ends) for ends in plan.walls.segments]
        self.tree = shapely.STRtree(self.lines)
        self.normals = plan.walls.normals.tolist()

    def cast(self, x: float, y: float, heading: float) -> tuple[float, int]:
        """Range and wall; nan and −1 where there is none."""
        end = (x + self.reach * math.cos(heading), y + self.reach * math.sin(heading))
        beam = shapely.LineString([(x, y), end])
        near = self.tree.query(beam, predicate="intersects")
        if len(near) == 0:
            return math.nan, -1
        met = shapely.intersection(beam, self.tree.geometries.take(near))
        ranges = shapely.distance(shapely.Point(x, y), met)
        first = int(ranges.argmin())
        return float(ranges[first]), int(near[first])


def played(scene: Scene, trees: Trees, run: int) -> tuple[float, float]:
    """One run of the classroom by filterpy and shapely: the sum of its NEES, and the last."""
    commands = [command for repeat in scene.commands for command in repeat.commands] * STEPS
    random = np.random.default_rng([scene.seed, run]).standard_normal((STEPS, 5)).tolist()
    world, noise, one, total, limit = scene.world, NOISE, robot(), 0.0, quantile(GATE, 1)
    last = math.nan
    one.x, one.P = world.told.start.copy(), np.diag(world.told.sigma**2)
    x, y, θ = (world.start + world.start_sigma * np.array(random[0][:3])).tolist()
    for k, (n1, n2, n3, n4, n5) in enumerate(random):
        move, sense = commands[2 * k], commands[2 * k + 1]
        d, a = (
            move.distance * (1 + noise.execution_distance * n1),
            move.angle * (1 + noise.execution_angle * n2),
        )
        x, y, θ = x + d * math.cos(θ), y + d * math.sin(θ), wrap_one(θ + a)
        one.predict((d * (1 + noise.odometry_distance * n3), a * (1 + noise.odometry_angle * n4)))
        truth = np.array([x, y, θ])
        total += nees_one(one.x, one.P, truth)
        z = trees.cast(x, y, θ + sense.angle)[0] * (1 + noise.range * n5)
        px, py, pθ = one.x.tolist()
        direction = pθ + sense.angle
        r, wall = trees.cast(px, py, direction)
        if wall >= 0 and not math.isnan(z):
            c, s = math.cos(direction), math.sin(direction)
            nx, ny = trees.normals[wall]
            n_d = nx * c + ny * s
            H = np.array([[-nx / n_d, -ny / n_d, -r * (ny * c - nx * s) / n_d]])
            one.R = np.array([[(noise.range * r) ** 2]])
            if (z - r) ** 2 <= limit * float((H @ one.P @ H.T + one.R)[0, 0]):
                one.update(np.array([z]), lambda x, H=H: H, lambda x, r=r: np.array([r]))
        last = nees_one(one.x, one.P, truth)
        total += last
    return total, last


def play_all(scene: Scene, trees: Trees, runs: list[int]) -> float:
    return sum(played(scene, trees, run)[0] for run in runs)


if __name__ == "__main__":
    main()
