"""Beams left out, and beams that are predicted as they truly are: by what the truth meets in the
map that the filter is told.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ekfsim.commands import Kidnap
from ekfsim.diagnostics.ambiguity import GRAZING
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.models.sensors.laser import ALONG, Laser
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.why.records import Change


class Met(NamedTuple):
    """What a beam meets from some poses (…) in the map that the filter is told."""

    range: Array  # (…) m, nan where there is no wall
    wall: Integers  # (…), −1 where there is none
    line: Integers  # (…) the straight line that the wall lies on, −1 where there is none
    n: Array  # (…, 2) the wall's normal where it is met
    d: Array  # (…, 2) the beam's direction

    @property
    def incidence(self) -> Array:
        """(…) rad between beam and wall; nan where there is no wall"""
        sine = np.minimum(np.abs(np.vecdot(self.n, self.d)), 1.0)
        return np.where(self.wall >= 0, np.arcsin(sine), np.nan)


def met(beam: Laser, pose: Array) -> Met:
    """What the beam meets from poses (…, 3)."""
    heading = pose[..., 2] + beam.bearing
    hit = beam.walls.cast(pose[..., :2], heading)
    d = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    n = beam.walls.normal_at(hit.wall, pose[..., :2] + hit.range[..., None] * d)
    line = hit.wall
    if len(beam.walls.line):
        line = np.where(hit.wall >= 0, beam.walls.line[hit.wall], -1)
    return Met(hit.range, hit.wall, line, n, d)


def astray(step: Step) -> bool:
    """Whether the beam of a step was predicted to meet another wall line than the truth meets."""
    match step.entry:
        case Entry(given=Reading(Laser() as beam, _), truth=np.ndarray() as truth):
            return bool(met(beam, step.prior.mean).line != met(beam, truth).line)
    return False


@dataclass(frozen=True, slots=True, eq=False)
class OfItsWall(Sensor):
    """The beam of a laser to the straight line of the wall that it truly meets, wherever the
    estimate stands.
    """

    bearing: float
    range_ratio: float
    place: Array  # (…, 2) m, where the wall is met
    normal: Array  # (…, 2) of the wall there

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One range."""
        return (Quantity("range", "m"),)

    def h(self, x: Array) -> Array:
        """r = n·(a − p) / n·d : (…, 1) m, nan where the line is behind the beam"""
        return self._met(x)[0][..., None]

    def H(self, x: Array) -> Array:
        """∂r/∂p = −n / n·d      ∂r/∂θ = −r n·d⊥ / n·d : (…, 1, 3), 0 where h is nan"""
        r, n, d, n_d = self._met(x)
        aside = np.stack([-d[..., 1], d[..., 0]], axis=-1)
        across = r * np.vecdot(n, aside)
        rows = np.stack(np.broadcast_arrays(n[..., 0], n[..., 1], across), axis=-1)
        known = ~np.isnan(r)[..., None]
        H = np.where(known, -rows / np.where(known, n_d[..., None], 1.0), 0.0)
        return np.asarray(H)[..., None, :]

    def R(self, x: Array) -> Array:
        """(ratio · r)² : (…, 1, 1)"""
        return np.square(self.range_ratio * self.h(x))[..., None]

    def of_run(self, run: tuple[int | Integers, ...]) -> Sensor:
        """With the wall that is met in that run."""
        return replace(self, place=_one(self.place, run, 1), normal=_one(self.normal, run, 1))

    def _met(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """r : (…), n and d : (…, 2) each, n·d : (…)"""
        axes = (1,) * (x.ndim - self.place.ndim)  # sigma points, particles
        a, n = (one.reshape((*one.shape[:-1], *axes, 2)) for one in (self.place, self.normal))
        heading = x[..., 2] + self.bearing
        d = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        n_d = np.vecdot(n, d)
        along = np.vecdot(n, a - x[..., :2])
        with np.errstate(divide="ignore", invalid="ignore"):
            r = np.where(np.abs(n_d) > ALONG, along / n_d, np.nan)
        return np.where(r > 0, r, np.nan), n, d, n_d


@dataclass(frozen=True, slots=True, eq=False)
class LikeLaser(Sensor):
    """What a laser is, but for what is told of it besides."""

    laser: Laser

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One range."""
        return self.laser.outputs

    def h(self, x: Array) -> Array:
        """(…, 1) m"""
        return self.laser.h(x)

    def H(self, x: Array) -> Array:
        """(…, 1, 3)"""
        return self.laser.H(x)

    def R(self, x: Array) -> Array:
        """(…, 1, 1)"""
        return self.laser.R(x)


@dataclass(frozen=True, slots=True, eq=False)
class OnItsWall(LikeLaser):
    """A laser that predicts nothing where the estimate would have it meet another wall line than it
    truly meets: such a reading is not used.
    """

    line: Integers  # (…) that it truly meets, −1 where it meets none

    def h(self, x: Array) -> Array:
        """That of the laser, nan where it is another wall's : (…, 1) m"""
        right = met(self.laser, x).line == _beside(self.line, x)
        return np.where(right[..., None], self.laser.h(x), math.nan)

    def H(self, x: Array) -> Array:
        """That of the laser, 0 where h is nan : (…, 1, 3)"""
        return np.where(np.isnan(self.h(x))[..., None], 0.0, self.laser.H(x))

    def of_run(self, run: tuple[int | Integers, ...]) -> Sensor:
        """With the line that is met in that run."""
        return replace(self, line=self.line[run] if self.line.ndim else self.line)


@dataclass(frozen=True, slots=True, eq=False)
class OfItsNoise(LikeLaser):
    """A laser whose noise is that of the range it truly measures, wherever the estimate stands."""

    variance: Array  # (…) m²

    def R(self, x: Array) -> Array:
        """(ratio · true range)² : (…, 1, 1)"""
        variance = _beside(self.variance, x)  # a filter about a plan asks of one state for all runs
        R = np.broadcast_to(variance, np.broadcast_shapes(variance.shape, x.shape[:-1]))
        return R[..., None, None]

    def of_run(self, run: tuple[int | Integers, ...]) -> Sensor:
        """With the noise of that run's range."""
        return replace(self, variance=_one(self.variance, run))


def _one(of_runs: Array, run: tuple[int | Integers, ...], inner: int = 0) -> Array:
    """What is one run's; what is the same for all has no axes but its `inner` ones."""
    return np.asarray(of_runs[run]) if of_runs.ndim > inner else of_runs


def _beside(of_runs: Array | Integers, x: Array) -> Array:
    """A number of each run beside states of it, of which there may be more: sigma points,
    particles.
    """
    axes = (1,) * (x.ndim - 1 - of_runs.ndim)
    return np.asarray(of_runs.reshape((*of_runs.shape, *axes)))


def sensed(entry: Entry, sensor: Callable[[Laser, Array], Sensor]) -> Entry:
    """The entry with what takes the place of its laser, by the truth; any other entry as it is."""
    match entry:
        case Entry(given=Reading(Laser() as beam, _) as reading, truth=np.ndarray() as truth):
            return replace(entry, given=replace(reading, sensor=sensor(beam, truth)))
    return entry


def of_its_wall(beam: Laser, truth: Array) -> Sensor:
    """The beam to the line of the wall that it meets from the truth (…, 3)."""
    found = met(beam, truth)
    if np.isnan(found.range).any():  # a beam that meets nothing has no line to be held to
        return beam
    place = truth[..., :2] + found.range[..., None] * found.d
    return OfItsWall(beam.bearing, beam.range_ratio, place, found.n)


def on_its_wall(beam: Laser, truth: Array) -> Sensor:
    """The beam, used only where it is predicted on the wall line that it meets from the truth."""
    return OnItsWall(beam, np.asarray(met(beam, truth).line))


def of_its_noise(beam: Laser, truth: Array) -> Sensor:
    """The beam with the noise of its true range."""
    found = met(beam, truth).range
    return OfItsNoise(beam, np.square(beam.range_ratio * np.where(np.isnan(found), 1.0, found)))


def left_out(entry: Entry, where: Booleans | bool = True) -> Entry:
    """The entry without its reading, in the runs (…) that are said."""
    if not isinstance(entry.given, Reading):
        return entry
    z = np.where(np.asarray(where)[..., None], math.nan, entry.given.z)
    return replace(entry, given=replace(entry.given, z=z))


def without_grazing(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Every entry, without the readings of beams that graze the wall that they meet."""
    for entry in entries:
        match entry:
            case Entry(given=Reading(Laser() as beam, _), truth=np.ndarray() as truth):
                yield left_out(entry, met(beam, truth).incidence < GRAZING)
            case _:
                yield entry


def repeated(entries: Iterable[Entry]) -> Iterator[bool]:
    """Of every entry, whether it is a beam in a direction in which the robot has looked already
    since it moved.
    """
    looked: set[float] = set()
    for entry in entries:
        match entry:
            case Entry(given=Reading(Laser(bearing=bearing), _)):
                yield bearing in looked
                looked.add(bearing)
            case _:
                if isinstance(entry.given, Control) or isinstance(entry.command, Kidnap):
                    looked.clear()
                yield False


def without_repeated(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Every entry, but only the first of readings in one direction from one place."""
    kept, asked = itertools.tee(entries)
    for entry, again in zip(kept, repeated(asked), strict=True):
        yield left_out(entry) if again else entry


WALL = Change(
    "wall",
    "each beam held to the wall that it truly meets",
    "predicted on that wall's line",
    of_entries=lambda entries: (sensed(entry, of_its_wall) for entry in entries),
)
ASTRAY = Change(
    "beams",
    "the beams that are predicted on a wrong wall",
    "left out",
    of_entries=lambda entries: (sensed(entry, on_its_wall) for entry in entries),
)
NOISE_AT_TRUTH = Change(
    "beams",
    "the noise of each beam made true",
    "by its true range, not by the predicted one",
    of_entries=lambda entries: (sensed(entry, of_its_noise) for entry in entries),
)
AMBIGUOUS = Change(
    "beams",
    "the ambiguous beams",
    "left out, as the guard does",
    of_scene=lambda scene: replace(scene, guard="skip"),
)
GRAZING_BEAMS = Change(
    "beams", "the grazing beams", "left out where they meet their wall at less than 15 degrees",
    of_entries=without_grazing,
)  # fmt: skip
REPEATED = Change(
    "beams", "all repeated beams but the first", "left out",
    of_entries=without_repeated,
)  # fmt: skip


def grazes(entry: Entry) -> bool:
    """Whether the beam of one run's entry truly grazes the wall that it meets."""
    match entry:
        case Entry(given=Reading(Laser() as beam, _), truth=np.ndarray() as truth):
            return bool(met(beam, truth).incidence < GRAZING)
    return False
