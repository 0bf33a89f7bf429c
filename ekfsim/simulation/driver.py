"""Who drives a simulated robot along its way: the truth moves here, tick by tick."""

import math
from typing import Any

import numpy as np

from ekfsim.filters.conditioning import square_root
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap, wrap_one
from ekfsim.simulation.draws import Stream
from ekfsim.systems.drives import Course
from ekfsim.systems.robots import Tick

# 1/s, rad/s per m, 1/s: how hard the driver steers back to the way
ALONG, ACROSS, AROUND = 1.0, 1.0, 2.0


class Driver:
    """Drives a robot, or N side by side, and steers back to the way what the process noise
    disturbs.

    He sees the true pose, as one does who stands beside; no filter has a part in it. One run is
    driven in plain floats, N in arrays (N,), by the same lines.
    """

    def __init__(
        self,
        course: Course,
        wanted: Array,
        start: Array,
        rate: float,
        process: Array,
        disturbances: Stream,
    ) -> None:
        """wanted : (T + 1, 3) poses on the way; start : (…, 3) true poses; process : (3, 3), Q of
        the pose in a tick
        """
        one = start.ndim == 1
        self._cos: Any = math.cos if one else np.cos  # of a float, or of an array
        self._sin: Any = math.sin if one else np.sin
        self._wrap: Any = wrap_one if one else wrap
        self._dt = 1 / rate
        # after the last tick it would go on as it went
        speed = np.append(course.speed, course.speed[-1:])
        turn_rate = np.append(course.turn_rate, course.turn_rate[-1:])
        self._asked = np.column_stack([speed, turn_rate, np.sign(speed), wanted])  # (T + 1, 6)
        self._gains = (ALONG, ACROSS, AROUND) if course.held else (0.0, 0.0, 0.0)
        self._root, self._disturbances = square_root(process), disturbances
        pose = start.tolist() if one else list(start.T)
        self._here = (*pose, *self._steered(self._asked[0].tolist(), *pose))

    def advance(self, ticks: Integers) -> tuple[Tick, Array]:
        """How the robot moves in each of the next T ticks, and its pose (T, …, 3) when it has been
        disturbed, too.
        """
        noise: Any = np.moveaxis(
            np.matvec(self._root, self._disturbances.normals(len(ticks), 3)), -1, 1
        )
        rows, asked = [self._here], self._asked[ticks + 1].tolist()
        for following, (ex, ey, eθ) in zip(
            asked, noise.tolist() if noise.ndim == 2 else noise, strict=True
        ):
            x, y, θ, distance, turn = rows[-1]
            middle = θ + turn / 2
            x, y = x + distance * self._cos(middle) + ex, y + distance * self._sin(middle) + ey
            θ = self._wrap(θ + turn + eθ)
            rows.append((x, y, θ, *self._steered(following, x, y, θ)))
        self._here = rows[-1]
        states = np.moveaxis(np.array(rows), 1, -1)
        return _ticks(states, self._dt), states[1:, ..., :3]

    def _steered(self, asked: list[float], x: Any, y: Any, θ: Any) -> tuple[Any, Any]:
        """Way and turn of a tick: what the course asks for, and back towards the wanted pose."""
        speed, turn_rate, sign, x_wanted, y_wanted, θ_wanted = asked
        along, across, around = self._gains
        dx, dy, c, s = x_wanted - x, y_wanted - y, self._cos(θ), self._sin(θ)
        speed = speed + along * (c * dx + s * dy)
        turn_rate = (
            turn_rate + sign * across * (c * dy - s * dx) + around * self._wrap(θ_wanted - θ)
        )
        return speed * self._dt, turn_rate * self._dt


def ticks_of(course: Course, poses: Array, dt: float) -> Tick:
    """The T ticks of a robot that is on its course throughout; poses : (T + 1, 3)"""
    asked = np.column_stack([course.speed, course.turn_rate]) * dt
    return _ticks(np.column_stack([poses, np.concatenate([asked, asked[-1:]])]), dt)


def _ticks(states: Array, dt: float) -> Tick:
    """T ticks, of x, y, θ, way and turn before each and after the last : (T + 1, …, 5). Arcs, by
    the mid-point rule.
    """
    pose, distance, turn = states[:-1, ..., :3], states[..., 3], states[..., 4]
    middle = states[..., 2] + turn / 2
    steps = distance[..., None] * np.stack([np.cos(middle), np.sin(middle)], axis=-1)
    after = np.concatenate(
        [pose[..., :2] + steps[:-1], wrap(pose[..., 2] + turn[:-1])[..., None]], axis=-1
    )
    return Tick(pose, after, distance[:-1], turn[:-1], steps[:-1] / dt, steps[1:] / dt, dt)
