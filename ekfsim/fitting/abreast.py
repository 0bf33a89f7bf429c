"""Many sets of numbers tried in one run of the filter: each is one of N runs side by side."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from ekfsim.filters.tuning import Tuning
from ekfsim.fitting.noises import Parts, Retold, anew, parts_of
from ekfsim.geometry import Array
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.unicycle import Stride, Unicycle
from ekfsim.models.protocols import Motion, Quantity, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.scene import Scene

FILTERS = ("ekf", "ukf")  # others look at some of the N runs by themselves
PROPORTIONAL = (MoveTurn, Unicycle, Stride)  # whose M takes (N,) numbers as it takes one


def possible(scene: Scene) -> bool:
    """Whether the filter of a scene looks at its models by what protocols.py offers alone."""
    usual = Tuning()
    return (
        scene.filter in FILTERS
        and scene.guard != "skip"
        and scene.tuning.range_variance == usual.range_variance
        and scene.tuning.cross_covariances == usual.cross_covariances
    )


def side_by_side(retold: Retold, values: Array, until: int | None = None) -> Scene:
    """The scene, its log given to N runs, each of which is told numbers of its own : (N, n)"""
    scene, runs = retold.scene, len(values)
    log = scene.log
    assert log is not None
    worlds = [retold.world(row.tolist()) for row in values]
    before, rows = parts_of(scene.world, scene), [parts_of(world, scene) for world in worlds]
    ratios = np.array([world.told.noise.range for world in worlds])
    after = Parts(
        None if rows[0].motion is None else _motions([row.motion for row in rows]),
        {name: Sensors(tuple(row.sensors[name] for row in rows)) for name in rows[0].sensors},
        lambda laser: Lasers(laser, ratios),
    )
    entries = tuple(
        Entry(one.index, _of_runs(anew(one.given, before, after), runs), t=one.t)
        for one in log.entries[:until]
    )
    return replace(scene, log=Log(entries, log.first))


def _of_runs(given: Control | Reading | None, runs: int) -> Control | Reading | None:
    """The same given to N runs."""
    match given:
        case Control(motion, u):
            return Control(motion, np.broadcast_to(u, (runs, *u.shape)))
        case Reading(sensor, z, name):
            return Reading(sensor, np.broadcast_to(z, (runs, *z.shape)), name)
    return given


def _motions(motions: Sequence[Any]) -> Motion:
    """One motion of N noises."""
    first = motions[0]
    if type(first) not in PROPORTIONAL:
        return Motions(tuple(motions))
    each = {one.name: [getattr(motion, one.name) for motion in motions] for one in fields(first)}
    made: Motion = type(first)(**{name: np.array(column) for name, column in each.items()})
    return made


@dataclass(frozen=True, slots=True, eq=False)
class Motions(Motion):
    """Motions that differ in their noise alone, one for each of N runs."""

    each: tuple[Motion, ...]

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """Those of all."""
        return self.each[0].inputs

    def f(self, x: Array, u: Array) -> Array:
        """That of all : (…, n)"""
        return self.each[0].f(x, u)

    def F(self, x: Array, u: Array) -> Array:
        """That of all : (…, n, n)"""
        return self.each[0].F(x, u)

    def G(self, x: Array, u: Array) -> Array:
        """That of all : (…, n, m)"""
        return self.each[0].G(x, u)

    def M(self, u: Array) -> Array:
        """Each run's own : (…, N, m, m)"""
        return np.stack([one.M(u[..., i, :]) for i, one in enumerate(self.each)], axis=-3)

    def Q(self, u: Array) -> Array | float:
        """Each run's own : (…, N, n, n); 0 where there is none"""
        own = [one.Q(u[..., i, :]) for i, one in enumerate(self.each)]
        if all(isinstance(Q, float) for Q in own):
            return float(max(np.max(Q) for Q in own))
        Q = np.stack([np.asarray(Q) for Q in own], axis=-3)
        return np.broadcast_to(Q, (*u.shape[:-1], *Q.shape[-2:]))


@dataclass(frozen=True, slots=True, eq=False)
class Sensors(Sensor):
    """Sensors that differ in their noise alone, one for each of N runs."""

    each: tuple[Sensor, ...]

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """Those of all."""
        return self.each[0].outputs

    def h(self, x: Array) -> Array:
        """That of all : (…, k)"""
        return self.each[0].h(x)

    def H(self, x: Array) -> Array:
        """That of all : (…, k, n)"""
        return self.each[0].H(x)

    def R(self, x: Array) -> Array:
        """Each run's own : (N, k, k)"""
        return np.stack([one.R(row) for one, row in zip(self.each, x, strict=True)])

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h, H and R."""
        h, H, _ = self.each[0].linearize(x)
        return h, H, self.R(x)

    def residual(self, z: Array, h: Array) -> Array:
        """That of all : (…, k)"""
        return self.each[0].residual(z, h)


@dataclass(frozen=True, slots=True, eq=False)
class Lasers(Sensor):
    """The classroom's laser, told a ratio of its own in each of N runs."""

    laser: Laser
    ratios: Array  # (N,)

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One range."""
        return self.laser.outputs

    def h(self, x: Array) -> Array:
        """That of all : (…, 1)"""
        return self.laser.h(x)

    def H(self, x: Array) -> Array:
        """That of all : (…, 1, 3)"""
        return self.laser.H(x)

    def R(self, x: Array) -> Array:
        """(ratio · r)² : (N, 1, 1)"""
        return self._noise(self.h(x))

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h, H and R."""
        h, H, _ = self.laser.linearize(x)
        return h, H, self._noise(h)

    def _noise(self, h: Array) -> Array:
        return np.square(self.ratios[:, None] * h)[..., None]
