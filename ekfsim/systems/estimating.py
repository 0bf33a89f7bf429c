"""A robot whose filter finds out, beside the pose, what it measures wrongly of its motion."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.layout import Layout
from ekfsim.models.motions.biased import Biased, Misread
from ekfsim.models.protocols import Motion
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.robot import Entries, Gps, Robot, Tick

STATES = {  # what each error is called among the entries of the state
    "gyro_bias": "gyro_bias",  # rad/s
    "wheel_scale": "wheel_scale_error",
    "left_scale": "left_scale_error",
    "right_scale": "right_scale_error",
    "turn_scale": "turn_scale_error",
    "forward_bias": "forward_bias",  # m/s²
    "lateral_bias": "lateral_bias",  # m/s²
    "yaw_bias": "yaw_bias",  # rad
}


class Estimate(NamedTuple):
    """How little is known of an error."""

    sigma: float  # at the start, in its own unit
    drift: float = 0.0  # density of its random walk, in its unit per √s


def estimable(robot: Robot) -> tuple[str, ...]:
    """What a filter may find out of a robot: its faults, and one scale for all of its way."""
    own = [name for name in robot.faults if name != "distance_scale"]
    scaled = "distance_scale" in robot.faults or "left_scale" in robot.faults
    return tuple(name for name in STATES if name in own or (name == "wheel_scale" and scaled))


@dataclass(frozen=True)
class Estimating:
    """The same robot, whose filter's state holds its errors as well."""

    robot: Robot
    estimates: tuple[tuple[str, Estimate], ...]

    @property
    def readings(self) -> tuple[DocumentReading, ...]:
        """Those of the robot."""
        return self.robot.readings

    @property
    def faults(self) -> Entries:
        """Those of the robot."""
        return self.robot.faults

    @property
    def over(self) -> Entries:
        """Those of the robot."""
        return self.robot.over

    @property
    def gps(self) -> Gps | None:
        """That of the robot."""
        return self.robot.gps

    @property
    def rate(self) -> float:
        """That of the robot."""
        return self.robot.rate

    @cached_property
    def layout(self) -> Layout:
        """The robot's own entries, then its errors."""
        own = self.robot.layout
        names = (*own.names, *(STATES[name] for name, _ in self.estimates))
        return Layout(names, own.position, own.heading, own.headings)

    def motion(self, reading: DocumentReading) -> Motion:
        """The robot's own, of an input that is put right."""
        motion = self.robot.motion(reading)
        names = [one.name for one in motion.inputs]
        return Biased(
            motion,
            len(self.robot.layout.names),
            tuple(self._misread(name, one) for name, one in self.estimates),
            names.index("dt") if "dt" in names else None,
            1 / self.robot.rate,
        )

    def first_covariance(self, reading: DocumentReading) -> Array:
        """P₀ : (n, n) of the robot, and σ² of each error."""
        own = self.robot.first_covariance(reading)
        n = len(own)
        P = np.diag([*np.zeros(n), *(one.sigma**2 for _, one in self.estimates)])
        P[:n, :n] = own
        return P

    def ideal(self, tick: Tick) -> Array:
        """That of the robot : (…, m)"""
        return self.robot.ideal(tick)

    def _misread(self, name: str, one: Estimate) -> Misread:
        """What an error does to the input."""
        faults = self.robot.faults
        if name != "wheel_scale":
            entries: tuple[int, ...] = (faults[name],)
        elif "distance_scale" in faults:
            entries = (faults["distance_scale"],)
        else:
            entries = faults["left_scale"], faults["right_scale"]
        return Misread(entries, name.endswith("_scale"), self.robot.over.get(name), one.drift)
