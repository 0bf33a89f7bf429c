"""The robots of the documents: what each measures of its motion, and the noise that is stated.

A robot tells the motion model that its filter uses, the first covariance, and (for a simulation)
what its instruments would say of a true motion were they free of noise.
"""

import math
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import ClassVar, Literal

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import INERTIAL, POSE, SPEED_POSE, Layout
from ekfsim.models.motions.odometry import ArctanOdometry, SkidSteer
from ekfsim.models.motions.planar_imu import PlanarImu
from ekfsim.models.motions.unicycle import Stride, Unicycle
from ekfsim.models.motions.wheel_speeds import WheelSpeeds, WheelSpeedsAsWritten
from ekfsim.models.motions.wheels import GyroWheels, TwoWheels, WheelsBesideGyro
from ekfsim.models.protocols import Motion
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.robot import Entries, Gps, Tick

WHEELS: Entries = MappingProxyType({"left_scale": 0, "right_scale": 1})
WAY_AND_TURN: Entries = MappingProxyType({"distance_scale": 0, "turn_scale": 1, "gyro_bias": 1})
NOTHING: Entries = MappingProxyType({})


def _wheel_ways(distance: Array, turn: Array, width: float) -> list[Array]:
    """ΔD_L and ΔD_R of two wheels `width` m apart."""
    half = turn * (width / 2)
    return [distance - half, distance + half]


def _stacked(tick: Tick, numbers: list[Array]) -> Array:
    """The numbers and dt as a motion input : (…, m)"""
    return np.stack(np.broadcast_arrays(*numbers, np.asarray(tick.dt)), axis=-1)


@dataclass(frozen=True)
class Mower:
    """Document 000: two wheels and a fibre-optic gyro at 100 Hz; u = (ΔD_L, ΔD_R, ω, dt)."""

    readings: ClassVar[tuple[DocumentReading, ...]] = ("coded",)
    faults: ClassVar[Entries] = MappingProxyType({**WHEELS, "gyro_bias": 2})
    over: ClassVar[Entries] = NOTHING
    gps: ClassVar[Gps | None] = None
    rate: float = 100.0
    width: float = 1.41  # m, b of eq. 20, as the listing has it
    wheel_sigma: float = 0.01  # m, of each wheel's way; the listing's varIn = 1e-4
    position_sigma: float = 0.01  # m, eq. 29
    heading_sigma: float = math.sqrt(7.62e-5)  # rad, eq. 29: 0.5°, as its variance is printed
    gyro_sigma: float = 0.0  # rad/s; the document leaves the gyro's noise to Q
    # what tells the turn: the gyro, or the wheels by eq. 20
    odometry: Literal["gyro", "midpoint"] = "gyro"
    layout: Layout = field(default=POSE, init=False)

    @property
    def process(self) -> Array:
        """Q : (3, 3)          eq. 29"""
        return np.diag([self.position_sigma**2, self.position_sigma**2, self.heading_sigma**2])

    def motion(self, reading: DocumentReading) -> Motion:
        """Wheels and gyro, or the wheels alone; alike in every reading."""
        made = GyroWheels if self.odometry == "gyro" else WheelsBesideGyro
        return made(self.width, self.wheel_sigma, self.process, self.gyro_sigma)

    def first_covariance(self, reading: DocumentReading) -> Array:
        """P₀ = Q"""
        return self.process

    def ideal(self, tick: Tick) -> Array:
        """ΔD_L, ΔD_R, ω, dt"""
        return _stacked(
            tick, [*_wheel_ways(tick.distance, tick.turn, self.width), tick.turn / tick.dt]
        )


@dataclass(frozen=True)
class Pioneer:
    """Document 001: a P3 robot.

    u = (ΔD_L, ΔD_R) as its wheels count them, or skid-steered (u_L, u_R, dt).
    """

    readings: ClassVar[tuple[DocumentReading, ...]] = ()
    faults: ClassVar[Entries] = WHEELS
    over: ClassVar[Entries] = NOTHING
    gps: ClassVar[Gps | None] = None
    rate: float = 10.0
    width: float = 0.38  # m, W of eq. 33; the document measures it and does not print it
    wheel_ratio: float = 0.05  # σ of a wheel's way, per m
    wheel_floor: float = 0.002  # m, and of a wheel at rest
    odometry: Literal["arctan", "midpoint", "skidSteer"] = "arctan"
    # eq. 30: rows u_x, u_y, ω of (R, L)
    skid: tuple[tuple[float, float], ...] = ((0.5, 0.5), (0.0, 0.0), (2.5, -2.5))
    skid_sigma: float = 0.02  # m/s, of each side's speed
    layout: Layout = field(default=POSE, init=False)

    def motion(self, reading: DocumentReading) -> Motion:
        """Eqs 31 to 33, or another model of the same wheels.

        Alike in every reading, for they are right as printed.
        """
        match self.odometry:
            case "skidSteer":
                return SkidSteer(self.skid, self.skid_sigma)
            case "midpoint":
                return TwoWheels(self.width, self.wheel_floor)
        return ArctanOdometry(self.width, self.wheel_ratio, self.wheel_floor)

    def first_covariance(self, reading: DocumentReading) -> Array:
        """The robot is set down on its mark to 2 cm and 2°."""
        return np.diag([0.02, 0.02, math.radians(2.0)]) ** 2

    def ideal(self, tick: Tick) -> Array:
        """The wheels' ways whose model makes the true turn of them; skid-steered their speeds."""
        if self.odometry == "skidSteer":
            forward, turning = self.skid[0], self.skid[2]
            sides = (
                np.linalg.solve(np.array([forward, turning]), np.stack([tick.distance, tick.turn]))
                / tick.dt
            )
            return _stacked(tick, [sides[1], sides[0]])
        turn = np.tan(tick.turn) if self.odometry == "arctan" else tick.turn
        return np.stack(_wheel_ways(tick.distance, turn, self.width), axis=-1)


@dataclass(frozen=True)
class GnssMower:
    """Document 003: a lawn mower that measures its wheels at 200 Hz; u = (v_L, v_R, dt)."""

    readings: ClassVar[tuple[DocumentReading, ...]] = ("coded",)
    faults: ClassVar[Entries] = WHEELS
    over: ClassVar[Entries] = NOTHING
    gps: ClassVar[Gps | None] = None
    rate: float = 200.0
    half_track: float = 0.27  # m, R of the document
    speed_density: float = 0.10  # m/s per √Hz
    turn_density: float = 0.30  # rad/s per √Hz: the wheels do not follow the true yaw rate well
    start_speed_sigma: float = 1.0  # m/s, how little the first belief knows of the speed
    layout: Layout = field(default=SPEED_POSE, init=False)

    def motion(self, reading: DocumentReading) -> Motion:
        """The document's integrals; `coded`, its authors' recipe, kept as a counter-example."""
        if reading == "coded":
            return WheelSpeedsAsWritten(self.half_track)
        return WheelSpeeds(self.half_track, self.speed_density, self.turn_density)

    def first_covariance(self, reading: DocumentReading) -> Array:
        """V is not known, the pose to 5 cm and 0.05 rad; the recipe begins with the identity."""
        own = np.diag([self.start_speed_sigma, 0.05, 0.05, 0.05]) ** 2
        return np.eye(4) if reading == "coded" else own

    def ideal(self, tick: Tick) -> Array:
        """v_L, v_R, dt"""
        left, right = _wheel_ways(tick.distance, tick.turn, 2 * self.half_track)
        return _stacked(tick, [left / tick.dt, right / tick.dt])


@dataclass(frozen=True)
class PylonCart:
    """Document 004: a cart with an inertial unit; u = (a_x, a_y, yaw, dt)."""

    readings: ClassVar[tuple[DocumentReading, ...]] = ("printed", "coded")
    faults: ClassVar[Entries] = MappingProxyType(
        {"forward_bias": 0, "lateral_bias": 1, "yaw_bias": 2}
    )
    over: ClassVar[Entries] = NOTHING
    gps: ClassVar[Gps | None] = Gps(0.4, 2.0)
    rate: float = 10.0
    forward_sigma: float = math.sqrt(1.8373)  # m/s², R_t of eq. 10
    lateral_sigma: float = math.sqrt(1.1991)  # m/s²
    yaw_sigma: float = math.sqrt(0.00058709)  # rad
    layout: Layout = field(default=INERTIAL, init=False)

    def motion(self, reading: DocumentReading) -> Motion:
        """Eqs 5 to 7.

        `printed` has eq. 5's minus; the authors' code does not wrap the difference of two yaws.
        """
        return PlanarImu(
            self.forward_sigma,
            self.lateral_sigma,
            self.yaw_sigma,
            wrapped=reading == "corrected",
            lateral_sign=-1.0 if reading == "printed" else 1.0,
        )

    def first_covariance(self, reading: DocumentReading) -> Array:
        """P₀ = I"""
        return np.eye(7)

    def ideal(self, tick: Tick) -> Array:
        """Accelerations in the cart's frame, the yaw after the motion, dt."""
        east, north = np.moveaxis((tick.velocity_after - tick.velocity_before) / tick.dt, -1, 0)
        yaw = tick.after[..., 2]
        c, s = np.cos(yaw), np.sin(yaw)
        return _stacked(tick, [c * east + s * north, c * north - s * east, wrap(yaw)])


@dataclass(frozen=True)
class IRobotCreate:
    """The robots of the MRCLAM data: commanded speed and turn rate; u = (v, ω, dt)."""

    readings: ClassVar[tuple[DocumentReading, ...]] = ()
    faults: ClassVar[Entries] = WAY_AND_TURN
    over: ClassVar[Entries] = NOTHING
    gps: ClassVar[Gps | None] = None
    rate: float = 100.0
    distance_density: float = 0.02  # m per √s
    heading_density: float = 0.10  # rad per √s
    layout: Layout = field(default=POSE, init=False)

    def motion(self, reading: DocumentReading) -> Motion:
        """Alike in every reading: no document prints it."""
        return Unicycle(self.distance_density, self.heading_density)

    def first_covariance(self, reading: DocumentReading) -> Array:
        """1 cm and 0.01 rad"""
        return np.eye(3) * 0.01**2

    def ideal(self, tick: Tick) -> Array:
        """v, ω, dt"""
        return _stacked(tick, [tick.distance / tick.dt, tick.turn / tick.dt])


@dataclass(frozen=True)
class RangingMower:
    """The mower of the Plaza data: way and turn since the last row; u = (distance, turn, dt)."""

    readings: ClassVar[tuple[DocumentReading, ...]] = ()
    faults: ClassVar[Entries] = WAY_AND_TURN
    over: ClassVar[Entries] = MappingProxyType({"gyro_bias": 2})
    gps: ClassVar[Gps | None] = None
    rate: float = 10.0
    distance_density: float = 0.05  # m per √s
    heading_density: float = 0.01  # rad per √s
    layout: Layout = field(default=POSE, init=False)

    def motion(self, reading: DocumentReading) -> Motion:
        """Alike in every reading: no document prints it."""
        return Stride(self.distance_density, self.heading_density)

    def first_covariance(self, reading: DocumentReading) -> Array:
        """5 cm and 0.05 rad"""
        return np.eye(3) * 0.05**2

    def ideal(self, tick: Tick) -> Array:
        """Distance, turn, dt."""
        return _stacked(tick, [tick.distance, tick.turn])
