"""What every drive offers: a way to go, sampled."""

from typing import NamedTuple, Protocol

import numpy as np

from ekfsim.geometry import Array


class Course(NamedTuple):
    """What a drive asks for, sampled: N steps of dt s from a start."""

    speed: Array  # (N,) m/s
    turn_rate: Array  # (N,) rad/s
    held: bool  # whether the driver steers back when the robot strays from it

    def poses(self, start: Array, dt: float) -> Array:
        """Where a robot without noise stands before, between and after the steps : (N + 1, 3)

        In m, m, rad; the headings are not wrapped.
        """
        heading = start[2] + np.concatenate([[0.0], np.cumsum(self.turn_rate * dt)])
        middle = (heading[1:] + heading[:-1]) / 2
        steps = self.speed[:, None] * dt * np.stack([np.cos(middle), np.sin(middle)], axis=-1)
        return np.column_stack(
            [start[:2] + np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), heading]
        )


class Drive(Protocol):
    """A way to go."""

    def course(self, dt: float) -> Course:
        """Speeds and turn rates, `dt` s each."""
