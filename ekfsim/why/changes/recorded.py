"""What may be wrong with a filter of a recorded log, whose draws nobody can make again: it is told
other noises, readings and motions are put right by a guess, readings are taken at other instants.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ekfsim.diagnostics.innovations import named
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Integers
from ekfsim.models.protocols import Motion, Quantity, Sensor
from ekfsim.printable import in_a_line
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.systems.faults import DriveFaults
from ekfsim.systems.robot import Robot
from ekfsim.why.records import Change

UNSURE = 10.0  # times as unsure of the first belief


@dataclass(frozen=True, slots=True, eq=False)
class Louder(Sensor):
    """A sensor whose noise is so many times as large."""

    sensor: Sensor
    factor: Array  # (…)

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """Those of the sensor."""
        return self.sensor.outputs

    def h(self, x: Array) -> Array:
        """That of the sensor : (…, k)"""
        return self.sensor.h(x)

    def H(self, x: Array) -> Array:
        """That of the sensor : (…, k, n)"""
        return self.sensor.H(x)

    def R(self, x: Array) -> Array:
        """factor² R of the sensor : (…, k, k)"""
        return _squared(self.factor, x.ndim - 1) * self.sensor.R(x)

    def residual(self, z: Array, h: Array) -> Array:
        """That of the sensor : (…, k)"""
        return self.sensor.residual(z, h)

    def of_run(self, run: tuple[int | Integers, ...]) -> Sensor:
        """With the factor of that run, where each has its own."""
        return replace(self, factor=np.asarray(self.factor[run])) if self.factor.ndim else self


@dataclass(frozen=True, slots=True, eq=False)
class LouderMotion(Motion):
    """A motion whose noises are so many times as large."""

    motion: Motion
    factor: Array  # (…)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """Those of the motion."""
        return self.motion.inputs

    def f(self, x: Array, u: Array) -> Array:
        """That of the motion : (…, n)"""
        return self.motion.f(x, u)

    def F(self, x: Array, u: Array) -> Array:
        """That of the motion : (…, n, n)"""
        return self.motion.F(x, u)

    def G(self, x: Array, u: Array) -> Array:
        """That of the motion : (…, n, m)"""
        return self.motion.G(x, u)

    def M(self, u: Array) -> Array:
        """factor² M of the motion : (…, m, m)"""
        return _squared(self.factor, u.ndim - 1) * self.motion.M(u)

    def Q(self, u: Array) -> Array | float:
        """factor² Q of the motion : (…, n, n), or 0 where there is none"""
        Q = self.motion.Q(u)
        return Q if np.ndim(Q) == 0 else _squared(self.factor, u.ndim - 1) * np.asarray(Q)

    def of_run(self, run: tuple[int | Integers, ...]) -> Motion:
        """With the factor of that run, where each has its own."""
        return replace(self, factor=np.asarray(self.factor[run])) if self.factor.ndim else self


def _squared(factor: Array, axes: int) -> Array:
    """factor² beside matrices of states with so many leading axes, of which some may be sigma
    points.
    """
    inner = max(axes - np.ndim(factor), 0) + 2
    return np.square(np.reshape(factor, (*np.shape(factor), *(1,) * inner)))


def of_sensor(entry: Entry, sensor: str) -> bool:
    """Whether an entry is a reading of that sensor, or of that target."""
    return isinstance(entry.given, Reading) and sensor in named(entry.given)


def louder(sensor: str, factor: float) -> Change:
    """The noise of a sensor, so many times as large."""

    def one(entry: Entry) -> Entry:
        given = entry.given
        if not isinstance(given, Reading) or not of_sensor(entry, sensor):
            return entry
        return replace(entry, given=replace(given, sensor=Louder(given.sensor, np.array(factor))))

    return _guess(f"{factor:.3g} times the told noise of {sensor}", one)


def louder_motion(factor: float) -> Change:
    """The noise of the motion, so many times as large."""

    def one(entry: Entry) -> Entry:
        given = entry.given
        if not isinstance(given, Control):
            return entry
        motion = LouderMotion(given.motion, np.array(factor))
        return replace(entry, given=replace(given, motion=motion))

    return _guess(f"{factor:.3g} times the told noise of the motion", one)


def louder_all(factor: float) -> Change:
    """Every noise that the filter is told, so many times as large."""

    def one(entry: Entry) -> Entry:
        by = np.array(factor)
        match entry.given:
            case Reading(sensor, z, name):
                return replace(entry, given=Reading(Louder(sensor, by), z, name))
            case Control(motion, u):
                return replace(entry, given=Control(LouderMotion(motion, by), u))
        return entry

    return _guess(f"{factor:.3g} times all told noises", one)


def unbiased(target: str, biases: Mapping[str, Array], told: str) -> Change:
    """What a sensor, or a target, reads too much all the while taken away. biases : by target"""

    def one(entry: Entry) -> Entry:
        given = entry.given
        if not isinstance(given, Reading) or named(given)[1] not in biases:
            return entry
        return replace(entry, given=replace(given, z=given.z - biases[named(given)[1]]))

    return _guess(f"a bias of {told} of {target} taken out", one)


def misread(robot: Robot, name: str, value: float, told: str) -> Change:
    """A scale or a bias of the motion input taken out, as if it were a fault of that name."""
    scale, wrong = name.endswith("_scale"), {name: value}
    right: Any = DriveFaults(**{name: 1 / value if scale else -value})  # type: ignore[arg-type]

    def one(entry: Entry) -> Entry:
        given = entry.given
        if not isinstance(given, Control):
            return entry
        u = right.misread(given.u, {n: robot.faults[n] for n in wrong}, robot.over)
        return replace(entry, given=replace(given, u=u))

    return _guess(f"a {name.replace('_', ' ')} of {told} of the robot taken out", one)


def without_surprises(at: frozenset[int], share: float) -> Change:
    """The readings that surprise beyond reason left out."""

    def one(entry: Entry) -> Entry:
        if entry.index not in at or not isinstance(entry.given, Reading):
            return entry
        given = entry.given
        return replace(entry, given=replace(given, z=np.full_like(given.z, np.nan)))

    told = f"{len(at)} left out, {100 * share:.2g} % of all"
    return Change(
        "reading", "the surprising readings", told, of_entries=lambda entries: map(one, entries)
    )


def later(sensor: str, by: float) -> Change:
    """The readings of a sensor taken by so many s earlier than they are stamped."""

    def of_entries(entries: Iterable[Entry]) -> Iterator[Entry]:
        everything = list(entries)
        moved = [
            replace(one, t=one.t - by) if one.t is not None and of_sensor(one, sensor) else one
            for one in everything
        ]
        start, *rest = moved
        rest.sort(key=lambda one: -np.inf if one.t is None else one.t)
        yield start
        truth = start.truth
        for one in rest:
            here = one.given is not None and of_sensor(one, sensor)
            truth = truth if here else one.truth
            yield replace(one, truth=truth) if here else one

    then = "earlier" if by > 0 else "later"
    name = f"the readings of {in_a_line(sensor)} taken {abs(by):g} s {then}"
    return Change("guess", name, of_entries=of_entries)


def unsure() -> Change:
    """A first belief that is ten times as unsure."""

    def of_scene(scene: Scene) -> Scene:
        assert scene.log is not None
        x, P = scene.log.first
        return replace(scene, log=replace(scene.log, first=Gaussian(x, UNSURE**2 * P)))

    return Change(
        "sigma", "the told sigma of the start", f"{UNSURE:g} times as unsure", of_scene=of_scene
    )


def start_at_truth(pose: Array) -> Change:
    """A first belief at the true start."""

    def of_scene(scene: Scene) -> Scene:
        assert scene.log is not None
        x, P = scene.log.first
        x = x.copy()
        x[list(scene.world.layout.places)] = pose
        return replace(scene, log=replace(scene.log, first=Gaussian(x, P)))

    return Change("start", "the told start", "made that of the log's truth", of_scene=of_scene)


def _guess(name: str, one: Callable[[Entry], Entry]) -> Change:
    return Change("guess", in_a_line(name), of_entries=lambda entries: map(one, entries))
