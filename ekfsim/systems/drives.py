"""How a simulated robot is driven: by a list of speeds, or along a path that it is held to."""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim.systems.drive import Course, Drive


@dataclass(frozen=True)
class Stretch:
    """Some seconds at one speed and one turn rate."""

    speed: float  # m/s
    turn_rate: float  # rad/s
    duration: float  # s


@dataclass(frozen=True)
class Stretches:
    """A list of speeds, driven as they stand: whatever disturbs the robot carries it away."""

    stretches: tuple[Stretch, ...]

    def course(self, dt: float) -> Course:
        """Speeds and turn rates, `dt` s each."""
        return _sampled(self.stretches, dt, held=False)


@dataclass(frozen=True)
class Square:
    """Straight sides and turns in place."""

    side: float = 2.0  # m
    speed: float = 0.25  # m/s
    turn_rate: float = math.radians(45)  # rad/s
    laps: int = 1
    clockwise: bool = False

    def course(self, dt: float) -> Course:
        """Speeds and turn rates, `dt` s each.

        Each side and each turn is made exactly, at a speed just below.
        """
        sign = -1.0 if self.clockwise else 1.0
        along = _whole(self.side / self.speed, dt)
        turning = _whole(math.pi / 2 / self.turn_rate, dt)
        side, turn = (
            Stretch(self.side / along, 0.0, along),
            Stretch(0.0, sign * math.pi / 2 / turning, turning),
        )
        return _sampled((side, turn) * (4 * self.laps), dt, held=True)


@dataclass(frozen=True)
class Circle:
    """Round and round."""

    radius: float = 2.0  # m
    speed: float = 0.5  # m/s
    laps: float = 1.0
    clockwise: bool = False

    def course(self, dt: float) -> Course:
        """Speeds and turn rates, `dt` s each."""
        duration = _whole(2 * math.pi * self.radius * self.laps / self.speed, dt)
        turn = 2 * math.pi * self.laps / duration * (-1.0 if self.clockwise else 1.0)
        return _sampled((Stretch(self.radius * abs(turn), turn, duration),), dt, held=True)


@dataclass(frozen=True)
class Spiral:
    """From the outside of a field inwards, round and round, at a constant speed.

    It starts as the pose looks.
    """

    width: float = 50.0  # m, of the field across the first heading
    length: float = 75.0  # m, along it
    spacing: float = 4.0  # m between two rounds
    duration: float = 549.0  # s
    clockwise: bool = False

    def course(self, dt: float) -> Course:
        """Speeds and turn rates, `dt` s each.

        An ellipse whose axes shrink by the spacing at every round, down to a fifth, walked along by
        its arc length.
        """
        sign = -1.0 if self.clockwise else 1.0
        short = min(self.width, self.length) / 2
        rounds = 0.8 * short / self.spacing
        t = np.linspace(0.0, 2 * math.pi * rounds, 20_000)
        shrunk = 1 - 0.8 * t / t[-1]
        x, y = self.length / 2 * shrunk * np.sin(t), self.width / 2 * shrunk * -np.cos(t) * sign
        way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        heading = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
        steps = max(round(self.duration / dt), 1)
        turns = np.diff(np.interp(np.linspace(0.0, way[-1], steps + 1), way, heading))
        return Course(np.full(steps, way[-1] / (steps * dt)), turns / dt, held=True)


def _whole(duration: float, dt: float) -> float:
    """The duration, lengthened to a whole number of steps."""
    return max(math.ceil(duration / dt - 1e-9), 1) * dt


def _sampled(stretches: tuple[Stretch, ...], dt: float, held: bool) -> Course:
    """Each stretch as a whole number of steps, none lost to rounding over the list."""
    ends = np.rint(np.cumsum([stretch.duration for stretch in stretches]) / dt).astype(int)
    counts = np.diff(np.concatenate([[0], ends]))
    speed = np.repeat([stretch.speed for stretch in stretches], counts)
    turn_rate = np.repeat([stretch.turn_rate for stretch in stretches], counts)
    return Course(speed, turn_rate, held)


DRIVES: dict[str, type[Drive]] = {"square": Square, "circle": Circle, "spiral": Spiral}
