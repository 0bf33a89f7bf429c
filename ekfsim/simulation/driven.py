"""A robot that is driven, its instruments read at their own rates: drive + draws → Entries."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.models.noise import once
from ekfsim.models.protocols import Motion, angles
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.simulation.draws import Draws, Stream, true_start
from ekfsim.simulation.driver import Driver
from ekfsim.simulation.past import Past
from ekfsim.systems.drive import Drive
from ekfsim.systems.faults import SOUND, SensorFaults
from ekfsim.systems.instrument import Instrument, Seen, Target
from ekfsim.systems.robot import Gps
from ekfsim.twins import twinned

SOON = 1e-9  # of a period: what rounding makes of an instant
TICKS_AT_ONCE = 8_000  # of one run: the first picture does not wait for the last tick
# ticks times runs that are worked out together: one by one is slow, all at once takes much memory
AT_ONCE = 100_000
# the streams of random numbers, the last two for each target
DISTURBANCE, INPUT, FIX, READING, OUTLIER = range(5)


def drive(scene: Scene, way: Drive, draws: Draws) -> Iterator[Entry]:
    """The log of a driven robot: at every tick its motion input, then what is read at that instant.

    The truth follows the right equations and the robot's own numbers, whatever reading of the
    document and whatever numbers the filter is told. What disturbs the motion, the noise of its
    input and the noise of each target's readings are streams of their own (see `Stream`). They go
    on whether a target is seen or not, so no noise, range, field of view or fault changes the
    numbers of another.
    """
    world, robot, believed = scene.world, scene.world.robot, scene.world.believed_robot
    assert robot is not None
    told, motion, course = (
        believed.motion(scene.reading),
        robot.motion("corrected"),
        way.course(1 / robot.rate),
    )
    start, wanted = true_start(world, draws), course.poses(world.start, 1 / robot.rate)
    driver = Driver(
        course, wanted, start, robot.rate, _process(motion, world.layout), draws.stream(DISTURBANCE)
    )
    inputs, watches = draws.stream(INPUT), list(_watches(scene, draws))
    gps = None if robot.gps is None else _Fixes(robot.gps, draws.stream(FIX))
    past = Past(start, max((watch.late for watch in watches), default=0.0) * robot.rate)
    yield Entry(0, None, start, t=0.0)
    index = 0
    for ticks in _blocks(len(course.speed), start.size // 3):
        moved, truth = driver.advance(ticks)
        ideal = robot.ideal(moved)
        u = world.drive_faults.misread(ideal, robot.faults, robot.over) + _noise(
            motion.M(ideal), inputs
        )
        past.goes_on(truth)
        fixes = None if gps is None else gps.fixes(ticks, truth, robot.rate)
        readings = _readings(watches, ticks, past, u, robot.rate, world.layout)
        yield from written(
            Happened(told, u, truth, (ticks + 1) / robot.rate, readings, fixes), index
        )
        index += len(ticks) + sum(map(len, readings))


class Happened(NamedTuple):
    """What happened in T ticks."""

    told: Motion  # as the filter is told
    u: Array  # (T, …, m)
    truth: Array  # (T, …, 3) at the end of each
    t: Array  # (T,) s, of its end
    readings: list[list[Reading]]  # at the end of each
    fixes: Array | None  # (T, …, 2) m


@twinned
def written(happened: Happened, index: int) -> Iterator[Entry]:
    """The entries of it, numbered from index + 1."""
    told, u, truth, t, readings, fixes = happened
    for i, stamp in enumerate(t.tolist()):
        index += 1
        fix = None if fixes is None else fixes[i]
        yield Entry(index, Control(told, u[i]), truth[i], t=stamp, fix=fix)
        for reading in readings[i]:
            index += 1
            yield Entry(index, reading, truth[i], t=stamp)


class _Watch(NamedTuple):
    """One target of one instrument, what is wrong with the instrument, and the noise of its
    readings.
    """

    instrument: Instrument
    believed: Instrument  # as the filter is told
    told: Target
    true: Target
    faults: SensorFaults
    noise: Stream
    outliers: Stream | None  # None where there are none

    @property
    def late(self) -> float:
        """How much older its readings are than the filter takes them to be, in s.

        A reading is taken by the filter at the end of a tick, and stamped as much later as it is
        told: what it is told truly of a delay makes no difference.
        """
        return self.faults.delay + max(self.true.delay - self.told.delay, 0.0)

    def read(self, pose: Array, x: Array, u: Array) -> Array:
        """Its readings from true poses (D, …, 3) and their states x : (D, …, k), nan where it is
        not in view.
        """
        h, _, R = self.true.sensor.linearize(x)
        bias = np.broadcast_to(self.faults.bias or (0.0,), h.shape)
        h, bias, R = self.instrument.read(Seen(h, bias, R), pose, u)
        noise = _noise(np.nan_to_num(R), self.noise)
        if self.outliers is not None:
            struck = self.outliers.uniforms(len(noise)) < self.faults.outliers
            noise = np.where(struck[..., None], self.faults.outlier_size * noise, noise)
        z = h + bias + noise
        for i in angles(self.true.sensor.outputs):
            z[..., i] = wrap(z[..., i])
        z = self.instrument.as_given(z, self.believed)
        return np.where(self.instrument.sees(self.true, pose)[..., None], z, np.nan)


def _watches(scene: Scene, draws: Draws) -> Iterator[_Watch]:
    """All that the instruments may read, and draw for, seen or not."""
    world = scene.world
    both = zip(world.targets(scene.reading), world.true_targets(), strict=True)
    for number, ((believed, known), (instrument, real)) in enumerate(both):
        faults = world.drive_faults.sensors.get(instrument.called, SOUND)
        outliers = draws.stream(OUTLIER, number) if faults.outliers > 0 else None
        yield _Watch(
            instrument, believed, known, real, faults, draws.stream(READING, number), outliers
        )


def _readings(
    watches: list[_Watch], ticks: Integers, past: Past, u: Array, rate: float, layout: Layout
) -> list[list[Reading]]:
    """What is read at the end of each tick, of what at least one run has in view."""
    read: list[list[Reading]] = [[] for _ in ticks]
    for watch in watches:
        due = np.flatnonzero(_due(watch.instrument.rate, ticks, rate))
        if len(due) == 0:
            continue
        pose = past.before(ticks[due] + 1, watch.late * rate)
        z = watch.read(pose, layout.state(pose), u[due])
        met = np.any(~np.isnan(z.reshape(len(due), -1)), axis=-1)
        for i in np.flatnonzero(met).tolist():
            read[due[i]].append(Reading(watch.told.sensor, z[i], watch.told.name))
    return read


class _Fixes:
    """Fixes of a receiver that is recorded and not used, each held until the next."""

    def __init__(self, gps: Gps, stream: Stream) -> None:
        self._gps, self._stream = gps, stream
        self._held: Array | None = None

    def fixes(self, ticks: Integers, truth: Array, rate: float) -> Array:
        """The newest fix at the end of each tick : (T, …, 2) m"""
        fresh = _due(1 / self._gps.period, ticks - 1, rate)
        n = self._stream.normals(int(np.count_nonzero(fresh)), 2)
        taken = truth[fresh][..., :2] + self._gps.sigma * n
        known = taken if self._held is None else np.concatenate([self._held[None], taken])
        fixes: Array = known[np.cumsum(fresh) - (self._held is None)]
        self._held = fixes[-1]
        return fixes


def _due(often: float, ticks: Integers, rate: float) -> Booleans:
    """Whether an instrument that is read so often is read at the end of a tick. often, rate : Hz"""
    due: Booleans = np.floor((ticks + 1) / rate * often + SOON) > np.floor(
        ticks / rate * often + SOON
    )
    return due


def _noise(covariance: Array, stream: Stream) -> Array:
    """Noise of covariances (T, …, m, m) : (T, …, m)"""
    noise: Array = np.matvec(
        square_root(once(covariance)), stream.normals(len(covariance), covariance.shape[-1])
    )
    return noise


def _process(motion: Motion, layout: Layout) -> Array:
    """Q of the pose, for a tick : (3, 3). None of the right motions has one that depends on its
    input.
    """
    Q = motion.Q(np.zeros(len(motion.inputs)))
    return np.zeros((3, 3)) if np.ndim(Q) == 0 else layout.pose_covariance(np.asarray(Q))


def _blocks(ticks: int, runs: int) -> Iterator[Integers]:
    """The numbers of all ticks from 0, some at a time."""
    many = max(min(AT_ONCE // runs, TICKS_AT_ONCE), 1)
    for first in range(0, ticks, many):
        yield np.arange(first, min(first + many, ticks))
