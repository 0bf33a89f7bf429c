"""What every instrument offers, and what most share: how far they see, and to which sides."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.protocols import Sensor
from ekfsim.models.sensors.mounted import AT_THE_POSE, Mount, Mounted, carried
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
    delay: float = 0.0  # s, how old a reading of it is when it is stamped


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

    @property
    def called(self) -> str:
        """The name that tells it from others of its kind; the kind where it has none."""

    @property
    def mount(self) -> Mount:
        """Where it sits on the robot."""

    @property
    def delay(self) -> float:
        """How old its readings are when they are stamped, in s."""

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


@dataclass(frozen=True, kw_only=True)
class Carried:
    """What may be told of any instrument: its name, where it sits, how late it tells."""

    mount: Mount = AT_THE_POSE
    delay: float = 0.0  # s, how old a reading is when it is stamped
    label: str | None = None  # its name, where it has one of its own


class Looking(Carried):
    """An instrument that sees what is near enough and in one of its fields of view."""

    name: ClassVar[str]
    readings: ClassVar[tuple[DocumentReading, ...]] = ()
    by_pose: ClassVar[bool] = False  # whether its sensors know no state but a pose
    farthest: float  # m
    views: tuple[tuple[float, float], ...]  # rad from straight ahead, counter-clockwise: from, to

    @property
    def called(self) -> str:
        """Its name; the kind where it has none."""
        return self.label or self.name

    def targets(self, around: Surroundings) -> Iterator[Target]:
        """Everything that it may read, from where it sits."""
        wrapped = self.mount != AT_THE_POSE or (self.by_pose and around.layout != POSE)
        for target in self.things(around._replace(layout=POSE) if wrapped else around):
            sensor = target.sensor
            if wrapped:
                sensor = Mounted(sensor, self.mount, around.layout)
            yield target._replace(sensor=sensor, delay=self.delay)

    def things(self, around: Surroundings) -> Iterator[Target]:
        """Everything that it may read, from the pose that the state tells."""
        raise NotImplementedError

    def sees(self, target: Target, pose: Array) -> Booleans:
        """Whether a target is in view from a true pose (…, 3) of the robot : (…)"""
        if target.place is None:
            return np.ones(pose.shape[:-1], bool)
        if self.mount != AT_THE_POSE:
            pose = carried(pose, self.mount)
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
