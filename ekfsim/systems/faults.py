"""What is wrong with a driven robot and its instruments, and no one knows: neither the filter nor
the log tells.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from ekfsim.geometry import Array


@dataclass(frozen=True)
class SensorFaults:
    """What is wrong with the readings of one instrument."""

    # added to each entry of a reading, in its unit; () where nothing is
    bias: tuple[float, ...] = ()
    outliers: float = 0.0  # probability that a reading is one
    outlier_size: float = 10.0  # by which the noise of an outlier is multiplied
    delay: float = 0.0  # s: what is read at t is what was there at t − delay


SOUND = SensorFaults()


@dataclass(frozen=True)
class DriveFaults:
    """What is wrong with what a robot measures of its motion, and with its instruments, by their
    kind.
    """

    left_scale: float = 1.0
    right_scale: float = 1.0
    gyro_bias: float = 0.0  # rad/s
    distance_scale: float = 1.0
    turn_scale: float = 1.0
    forward_bias: float = 0.0  # m/s²
    lateral_bias: float = 0.0  # m/s²
    yaw_bias: float = 0.0  # rad
    # a plain one: workers of a study are sent it
    sensors: Mapping[str, SensorFaults] = field(default_factory=dict)

    def misread(
        self, u: Array, entries: Mapping[str, int], over: Mapping[str, int] = MappingProxyType({})
    ) -> Array:
        """The motion input that is measured where u : (…, m) is right. entries : which entry each
        fault is about; over : the entry, a time, over which a rate of it adds up
        """
        measured = u.copy()
        for name, entry in entries.items():
            if name.endswith("_scale"):
                measured[..., entry] *= getattr(self, name)
            else:
                rate = getattr(self, name)
                measured[..., entry] += rate * u[..., over[name]] if name in over else rate
        return measured


NOTHING_WRONG = DriveFaults()
