"""The instruments that the robots carry: how often they are read, what they see, their sensors.

An instrument makes one sensor for each thing that it may see: a landmark, a direction, the sky.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.sensors.infrared import COLOURS, InfraredBeam
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import (
    ALL_ROUND,
    Instrument,
    Looking,
    Seen,
    Surroundings,
    Target,
    turned,
)


@dataclass(frozen=True)
class Markers(Looking):
    """Document 000: cameras in front and behind, for azimuth and elevation of surveyed markers."""

    name: ClassVar[str] = "markers"
    readings: ClassVar[tuple[DocumentReading, ...]] = ("printed",)
    rate: float = 0.5
    height: float = 0.226  # m, μ: of the camera above the markers
    azimuth_sigma: float = 0.048  # rad, eq. 30
    elevation_sigma: float = 0.006  # rad
    farthest: float = 10.0
    views: tuple[tuple[float, float], ...] = (
        (math.radians(-30), math.radians(30)),
        (math.radians(150), math.radians(210)),
    )

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each marker; `printed` has the signs of eq. 25."""
        sign = -1.0 if around.reading == "printed" else 1.0
        for mark in around.landmarks:
            angles = MarkerAngles(
                mark.x,
                mark.y,
                self.height,
                self.azimuth_sigma,
                self.elevation_sigma,
                sign,
                around.layout,
            )
            yield Target(f"{self.label or 'marker'} {mark.id}", angles, (mark.x, mark.y))


@dataclass(frozen=True)
class RangeBearings(Looking):
    """A camera that tells range and bearing of landmarks."""

    name: ClassVar[str] = "rangeBearing"
    rate: float = 2.0
    range_sigma: float = 0.30  # m
    bearing_sigma: float = 0.02  # rad
    farthest: float = 5.0
    views: tuple[tuple[float, float], ...] = ((math.radians(-35), math.radians(35)),)

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each landmark."""
        for mark in around.landmarks:
            sensor = RangeBearing(
                mark.x, mark.y, self.range_sigma, self.bearing_sigma, around.layout
            )
            yield Target(f"{self.label or 'landmark'} {mark.id}", sensor, (mark.x, mark.y))


@dataclass(frozen=True)
class Bearings(Looking):
    """A camera that tells the bearing of landmarks alone."""

    name: ClassVar[str] = "bearing"
    rate: float = 2.0
    sigma: float = 0.02  # rad
    farthest: float = 5.0
    views: tuple[tuple[float, float], ...] = ((math.radians(-35), math.radians(35)),)

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each landmark."""
        for mark in around.landmarks:
            yield Target(
                f"{self.label or 'landmark'} {mark.id}",
                BearingOnly(mark.x, mark.y, self.sigma, around.layout),
                (mark.x, mark.y),
            )


@dataclass(frozen=True)
class Ranges(Looking):
    """A radio that tells the range to nodes alone.

    What it says is scale · r + bias, and is corrected before use.
    """

    name: ClassVar[str] = "range"
    rate: float = 4.0
    sigma: float = 0.6  # m
    scale: float = 1.066
    bias: float = 0.11  # m
    farthest: float = 100.0
    views: tuple[tuple[float, float], ...] = ALL_ROUND

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each node."""
        for mark in around.landmarks:
            yield Target(
                f"{self.label or 'node'} {mark.id}",
                RangeOnly(mark.x, mark.y, self.sigma, around.layout),
                (mark.x, mark.y),
            )

    def corrected(self, raw: float) -> float:
        """The range that a raw reading stands for, in m."""
        return (raw - self.bias) / self.scale

    def raw(self, z: Array) -> Array:
        """What it says where corrected ranges (…, 1) were read."""
        return self.scale * z + self.bias

    def as_given(self, z: Array, believed: Instrument) -> Array:
        """Readings corrected by the scale and the bias that the radio is believed to have."""
        if not isinstance(believed, Ranges):
            return z
        if (self.scale, self.bias) == (believed.scale, believed.bias):
            return z
        return (self.raw(z) - believed.bias) / believed.scale


@dataclass(frozen=True)
class Gnss(Looking):
    """Document 003: satellite fixes of the position."""

    name: ClassVar[str] = "gnss"
    readings: ClassVar[tuple[DocumentReading, ...]] = ("coded",)
    rate: float = 10.0
    sigma: float = 0.15  # m, on each axis

    def things(self, around: Surroundings) -> Iterator[Target]:
        """The fix; the recipe of the document's authors takes R = I."""
        sigma = 1.0 if around.reading == "coded" else self.sigma
        yield Target(self.called, Position(sigma, sigma, around.layout))


@dataclass(frozen=True)
class Pylon(Looking):
    """Document 004: a lidar; a pylon's offset, turned into the global frame by the yaw."""

    name: ClassVar[str] = "pylon"
    readings: ClassVar[tuple[DocumentReading, ...]] = ("printed", "coded")
    rate: float = 10.0
    sigma: float = 0.0075  # m, Q_t of eq. 10
    farthest: float = 100.0
    views: tuple[tuple[float, float], ...] = ALL_ROUND

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each pylon.

        Only `corrected` knows that an error of the yaw moves the reading sideways.
        """
        yaw_sigma = around.yaw_sigma if around.reading == "corrected" else 0.0
        for mark in around.landmarks:
            sensor = LandmarkOffset(
                mark.x, mark.y, self.sigma, self.sigma, around.layout, yaw_sigma
            )
            yield Target(self.called, sensor, (mark.x, mark.y))

    def read(self, seen: Seen, pose: Array, u: Array) -> Seen:
        """What the lidar sees with its own noise, turned by the yaw as it was measured."""
        h, bias = turned(seen.h, u[..., 2] - pose[..., 2]), turned(seen.bias, u[..., 2])
        return Seen(h, bias, np.broadcast_to(np.eye(2) * self.sigma**2, (*h.shape, 2)))


@dataclass(frozen=True)
class Lidar(Looking):
    """The same lidar, its reading left as it sees the pylon, as document 004's conclusion wants."""

    name: ClassVar[str] = "lidar"
    readings: ClassVar[tuple[DocumentReading, ...]] = ()
    rate: float = 10.0
    sigma: float = 0.0075  # m, Q_t of eq. 10
    farthest: float = 100.0
    views: tuple[tuple[float, float], ...] = ALL_ROUND

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each pylon."""
        for mark in around.landmarks:
            yield Target(
                self.called,
                LidarOffset(mark.x, mark.y, self.sigma, around.layout),
                (mark.x, mark.y),
            )


EIGHT = tuple(math.radians(angle) for angle in range(-180, 180, 45))
FOUR = tuple(math.radians(angle) for angle in range(-180, 180, 90))


@dataclass(frozen=True)
class Ultrasonic(Looking):
    """Document 001: a ring of ultrasonic beams; the error grows with the distance (fig. 6)."""

    name: ClassVar[str] = "ultrasonic"
    by_pose: ClassVar[bool] = True
    rate: float = 2.0
    bearings: tuple[float, ...] = EIGHT  # rad from straight ahead
    sigma: float = 0.005  # m
    sigma_per_metre: float = 0.01
    nearest: float = 0.1  # m
    farthest: float = 2.0

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each beam."""
        for number, bearing in enumerate(self.bearings):
            beam = UltrasonicBeam(
                around.walls, bearing, self.sigma, self.sigma_per_metre, self.nearest, self.farthest
            )
            yield Target(f"{self.called} {number}", beam)


@dataclass(frozen=True)
class Infrared(Looking):
    """Document 001: pairs of an infrared emitter and receiver (fig. 4).

    The intensity falls with the distance.
    """

    name: ClassVar[str] = "infrared"
    by_pose: ClassVar[bool] = True
    rate: float = 2.0
    bearings: tuple[float, ...] = FOUR
    gain: float = 1.0  # V per e-fold of the distance
    offset: float = 1.0  # V at 1 m from white
    colour: str = "white"  # of the walls
    sigma: float = 0.05  # V
    nearest: float = 0.1  # m
    farthest: float = 1.5

    def things(self, around: Surroundings) -> Iterator[Target]:
        """A sensor for each pair."""
        for number, bearing in enumerate(self.bearings):
            beam = InfraredBeam(
                around.walls, bearing, self.gain, self.offset, COLOURS[self.colour], self.sigma,
                self.nearest,
                self.farthest,
            )  # fmt: skip
            yield Target(f"{self.called} {number}", beam)


@dataclass(frozen=True)
class Compass(Looking):
    """Document 001: tells the absolute yaw.

    "In indoor conditions" it is of "rather poor quality", and so left out there.
    """

    name: ClassVar[str] = "compass"
    rate: float = 2.0
    sigma: float = math.radians(10)  # rad; the document prints none
    orientation: float = 0.0  # rad, β of eqs 36, 37: what it tells where the robot looks along +x

    def things(self, around: Surroundings) -> Iterator[Target]:
        """The yaw."""
        yield Target(self.called, Yaw(self.orientation, self.sigma, around.layout))


@dataclass(frozen=True)
class Gyro(Looking):
    """Document 001: a gyroscope that tells the yaw from the mark, along which it was set to 0.

    It has summed up its rates itself. What it drifts is no white noise: no filter here is told, see
    `faults`.
    """

    name: ClassVar[str] = "gyro"
    rate: float = 10.0
    sigma: float = math.radians(1)  # rad; the document prints none

    def things(self, around: Surroundings) -> Iterator[Target]:
        """The yaw, 0 along the mark, however it is mounted."""
        yield Target(self.called, Yaw(-around.mark - self.mount.theta, self.sigma, around.layout))


INSTRUMENTS: dict[str, type[Instrument]] = {
    kind.name: kind
    for kind in (
        Markers,
        RangeBearings,
        Ranges,
        Bearings,
        Gnss,
        Pylon,
        Lidar,
        Ultrasonic,
        Infrared,
        Compass,
        Gyro,
    )
}
