"""What every instrument offers, and what most share: how far they see, and to which sides."""

import math
from collections.abc import Iterator
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.models.protocols import Sensor
from ekfsim.raycast.walls import Walls
from ekfsim.systems.document import DocumentReading

ALL_ROUND = ((-math.pi, math.pi),)


class Landmark(NamedTuple):
    """A landmark: a point that a sensor can tell apart from all others. x, y in m"""

    id: int
    x: float
    y: float


class Surroundings(NamedTuple):
    """What an instrument's sensors are made from."""

    landmarks: tuple[Landmark, ...]
    walls: Walls  # of the map that the sensor is to know
    layout: Layout  # of the filter's state
    reading: DocumentReading
    yaw_sigma: float = 0.0  # rad, of the heading by which readings are turned into the global frame
    mark: float = 0.0  # rad, the heading of the mark on which the robot is set down


class Target(NamedTuple):
    """One thing that an instrument may read."""

    name: str  # as the narrative and the trace call the sensor: "marker 3"
    sensor: Sensor
    place: tuple[float, float] | None = None  # m, where it stands; None for what has no place


class Seen(NamedTuple):
    """A reading of a target before its noise is drawn. Arrays carry leading axes (…)."""

    h: Array  # (…, k) what would be read without noise
    bias: Array  # (…, k)
    R: Array  # (…, k, k) covariance of the noise


class Instrument(Protocol):
    """What a simulation and a recorded log need to know of an instrument."""

    name: ClassVar[str]  # the kind, as world files call it
    # in which other equations than the corrected ones are followed
    readings: ClassVar[tuple[DocumentReading, ...]]

    @property
    def rate(self) -> float:
        """How often it is read, in Hz."""

    def targets(self, around: Surroundings) -> Iterator[Target]:
        """Everything that it may read."""

    def sees(self, target: Target, pose: Array) -> Booleans:
        """Whether a target is in view from a true pose (…, 3) : (…)"""

    def read(self, seen: Seen, pose: Array, u: Array) -> Seen:
        """What it makes of a target that it sees from true poses (…, 3).

        u : (…, m), the motion input as the robot measures it
        """

    def as_given(self, z: Array, believed: "Instrument") -> Array:
        """Readings (…, k) as a filter is given them that believes this of the instrument."""


def turned(z: Array, angle: Array) -> Array:
    """Vectors (…, 2) turned counter-clockwise : (…, 2)"""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * z[..., 0] - s * z[..., 1], s * z[..., 0] + c * z[..., 1]], axis=-1)


class Looking:
    """An instrument that sees what is near enough and in one of its fields of view."""

    readings: ClassVar[tuple[DocumentReading, ...]] = ()
    farthest: float  # m
    views: tuple[tuple[float, float], ...]  # rad from straight ahead, counter-clockwise: from, to

    def sees(self, target: Target, pose: Array) -> Booleans:
        """Whether a target is in view from a true pose (…, 3) : (…)"""
        if target.place is None:
            return np.ones(pose.shape[:-1], bool)
        dx, dy = target.place[0] - pose[..., 0], target.place[1] - pose[..., 1]
        bearing = np.arctan2(dy, dx) - pose[..., 2]
        near: Booleans = np.hypot(dx, dy) <= self.farthest
        inside = np.zeros_like(near)
        for start, end in self.views:
            middle, half = (start + end) / 2, (end - start) / 2
            inside |= np.abs(wrap(bearing - middle)) <= half
        return near & inside

    def read(self, seen: Seen, pose: Array, u: Array) -> Seen:
        """What it makes of a target that it sees: nothing else."""
        return seen

    def as_given(self, z: Array, believed: Instrument) -> Array:
        """Readings as a filter is given them: as they are."""
        return z
