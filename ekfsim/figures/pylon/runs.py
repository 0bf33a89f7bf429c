"""Document 004's run, filtered under each reading and with what else its figures compare."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.figures.retold import retold
from ekfsim.figures.track import Track
from ekfsim.geometry import Array
from ekfsim.geometry.outline import path_error
from ekfsim.localization import filter_of, first_belief, localize
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset, from_global, to_global_as_printed
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.systems.document import READINGS, DocumentReading

PUBLISHED = 707, 73.4  # rows, and s from the start to the last of them


@dataclass(frozen=True)
class Told:
    """The run as a filter is told it under one reading of the document."""

    scene: Scene
    entries: tuple[Entry, ...]

    @classmethod
    def of(cls, scene: Scene, reading: DocumentReading) -> "Told":
        """The scene's log, or its simulation.
        Only `corrected` takes dt from the stamps, as the log's reader does.
        """
        told = retold(scene, reading)
        if told.log is None:
            return cls(told, tuple(simulate(told)))
        if reading == scene.reading:
            return cls(told, told.log.entries)
        assert scene.world.robot is not None
        constant = None if reading == "corrected" else 1 / scene.world.robot.rate
        return cls(told, tuple(timed(told.log.entries, constant)))

    def steps(self) -> Iterator[Step]:
        """What the scene's filter makes of it."""
        scene = self.scene
        return localize(
            self.entries, filter_of(scene), first_belief(scene), scene.guard, scene.world.layout
        )

    def track(self) -> Track:
        """The same as arrays."""
        return Track.of(self.steps(), self.scene.world.layout)

    def but(self, entries: Iterable[Entry]) -> "Told":
        """The same filter, told something else."""
        return Told(self.scene, tuple(entries))


@dataclass(frozen=True)
class Runs:
    """One run under every reading, and the outline that was to be driven."""

    told: dict[DocumentReading, Told]
    tracks: dict[DocumentReading, Track]
    ring: Array  # (n, 2) m
    reading: DocumentReading  # whose estimate the figures show

    @classmethod
    def of(cls, scene: Scene) -> "Runs":
        """Filter the scene under each reading."""
        told = {reading: Told.of(scene, reading) for reading in READINGS}
        assert scene.world.expected_path is not None
        tracks = {reading: each.track() for reading, each in told.items()}
        return cls(told, tracks, scene.world.expected_path, scene.reading)

    @property
    def published(self) -> bool:
        """Whether it is the log whose figures the authors' own program is known to give."""
        inputs = sum(isinstance(entry.given, Control) for entry in self.told["coded"].entries)
        last = self.told["corrected"].entries[-1].t
        return (
            self.told["coded"].scene.log is not None
            and last is not None
            and (inputs, round(last, 3)) == PUBLISHED
        )

    @property
    def track(self) -> Track:
        """The one that the figures show."""
        return self.tracks[self.reading]

    def off_path(self, track: Track) -> Array:
        """The path-tracking error of a track at every instant after the start,
        eq. 11 : (N − 1,) m
        """
        return path_error(track.pose[1:, :2], self.ring)


def timed(entries: Iterable[Entry], constant: float | None) -> Iterator[Entry]:
    """The same log with one dt for all motion inputs,
    in s, or where that is None with dt from its stamps.
    """
    before = 0.0
    for entry in entries:
        assert entry.t is not None
        if isinstance(entry.given, Control):
            u = entry.given.u.copy()
            u[3] = entry.t - before if constant is None else constant
            before = entry.t
            yield replace(entry, given=replace(entry.given, u=u))
        else:
            yield entry


def every_other(entries: Iterable[Entry]) -> Iterator[Entry]:
    """The same log without its second, fourth, … reading."""
    kept = False
    for entry in entries:
        if isinstance(entry.given, Reading):
            kept = not kept
            if not kept:
                continue
        yield entry


def by_the_letter(entries: Iterable[Entry]) -> Iterator[Entry]:
    """The same log, its readings turned into the global frame as eq. 8 is printed."""
    θ = 0.0
    for entry in entries:
        if isinstance(entry.given, Control):
            θ = float(entry.given.u[2])
        elif isinstance(entry.given, Reading):
            lidar = from_global(entry.given.z, θ)
            entry = replace(entry, given=replace(entry.given, z=to_global_as_printed(lidar, θ)))
        yield entry


def in_its_own_frame(entries: Iterable[Entry]) -> Iterator[Entry]:
    """The same log, its readings as the lidar saw them:
    turned back by the yaw that had turned them.
    """
    θ: Array = np.zeros(())
    for entry in entries:
        if isinstance(entry.given, Control):
            θ = entry.given.u[..., 2]
        elif isinstance(entry.given, Reading) and isinstance(entry.given.sensor, LandmarkOffset):
            seen, z = entry.given.sensor, from_global(entry.given.z, θ)
            lidar = LidarOffset(seen.x, seen.y, seen.sigma_x, seen.layout)
            entry = replace(entry, given=Reading(lidar, z, "lidar"))
        yield entry


def turned_by_the_yaw_of(entries: Iterable[Entry], later: int) -> Iterator[Entry]:
    """The same log, each reading turned by the yaw of so many rows later,
    or earlier where that is negative.
    """
    log = list(entries)
    yaws = [float(entry.given.u[2]) for entry in log if isinstance(entry.given, Control)]
    row = -1
    for entry in log:
        if isinstance(entry.given, Control):
            row += 1
        elif isinstance(entry.given, Reading):
            turn = yaws[min(max(row + later, 0), len(yaws) - 1)] - yaws[row]
            c, s = np.cos(turn), np.sin(turn)
            entry = replace(
                entry, given=replace(entry.given, z=np.array([[c, -s], [s, c]]) @ entry.given.z)
            )
        yield entry


def as_noisy(entries: Iterable[Entry], sigma: float) -> Iterator[Entry]:
    """The same log, the filter told another σ of the lidar, in m."""
    for entry in entries:
        if isinstance(entry.given, Reading) and isinstance(entry.given.sensor, LandmarkOffset):
            sensor = replace(entry.given.sensor, sigma_x=sigma, sigma_y=sigma)
            entry = replace(entry, given=replace(entry.given, sensor=sensor))
        yield entry


def lidar_alone(told: Told) -> Array:
    """Where each reading, turned by the yaw, puts the robot without any filter : (K, 2) m"""
    places = [
        np.array([entry.given.sensor.x, entry.given.sensor.y]) - entry.given.z
        for entry in told.entries
        if isinstance(entry.given, Reading) and isinstance(entry.given.sensor, LandmarkOffset)
    ]
    return np.array(places).reshape(-1, 2)
