"""Who drives a simulated robot along its way: the truth moves here, tick by tick."""

import numpy as np

from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.simulation.draws import Stream
from ekfsim.systems.drive import Course
from ekfsim.systems.robot import Tick
from ekfsim.twins import twinned

# 1/s, rad/s per m, 1/s: how hard the driver steers back to the way
ALONG, ACROSS, AROUND = 1.0, 1.0, 2.0
Gains = tuple[float, float, float]


class Driver:
    """Drives a robot, or N side by side, and steers back to the way what the process noise
    disturbs.

    He sees the true pose, as one does who stands beside; no filter has a part in it.
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
        self._dt = 1 / rate
        # after the last tick it would go on as it went
        speed = np.append(course.speed, course.speed[-1:])
        turn_rate = np.append(course.turn_rate, course.turn_rate[-1:])
        self._asked = np.column_stack([speed, turn_rate, np.sign(speed), wanted])  # (T + 1, 6)
        self._gains = (ALONG, ACROSS, AROUND) if course.held else (0.0, 0.0, 0.0)
        self._root, self._disturbances = square_root(process), disturbances
        x, y, θ = np.moveaxis(start, -1, 0)
        self._here = np.stack(
            [x, y, θ, *steered(self._asked[0], x, y, θ, self._gains, self._dt)], axis=-1
        )

    def advance(self, ticks: Integers) -> tuple[Tick, Array]:
        """How the robot moves in each of the next T ticks, and its pose (T, …, 3) when it has been
        disturbed, too.
        """
        noise = np.matvec(self._root, self._disturbances.normals(len(ticks), 3))
        states = driven(self._here, self._asked[ticks + 1], noise, self._gains, self._dt)
        self._here = states[-1]
        return _ticks(states, self._dt), states[1:, ..., :3]


@twinned
def driven(here: Array, asked: Array, noise: Array, gains: Gains, dt: float) -> Array:
    """x, y, θ, way and turn before each of T ticks and after the last : (T + 1, …, 5)

    here : (…, 5), before the first; asked : (T, 6), what the course asks for after each, its
    direction and the wanted pose; noise : (T, …, 3), what disturbs the pose
    """
    rows = [here]
    for following, (ex, ey, eθ) in zip(asked, np.moveaxis(noise, -1, 1), strict=True):
        x, y, θ, distance, turn = np.moveaxis(rows[-1], -1, 0)
        middle = θ + turn / 2
        x, y = x + distance * np.cos(middle) + ex, y + distance * np.sin(middle) + ey
        θ = wrap(θ + turn + eθ)
        rows.append(np.stack([x, y, θ, *steered(following, x, y, θ, gains, dt)], axis=-1))
    return np.array(rows)


def steered(
    asked: Array, x: Array, y: Array, θ: Array, gains: Gains, dt: float
) -> tuple[Array, Array]:
    """Way and turn of a tick: what the course asks for, and back towards the wanted pose."""
    speed, turn_rate, sign, x_wanted, y_wanted, θ_wanted = asked
    along, across, around = gains
    dx, dy, c, s = x_wanted - x, y_wanted - y, np.cos(θ), np.sin(θ)
    speed = speed + along * (c * dx + s * dy)
    turn_rate = turn_rate + sign * across * (c * dy - s * dx) + around * wrap(θ_wanted - θ)
    return speed * dt, turn_rate * dt


def ticks_of(course: Course, poses: Array, dt: float) -> Tick:
    """The T ticks of a robot that is on its course throughout; poses : (T + 1, 3)"""
    asked = np.column_stack([course.speed, course.turn_rate]) * dt
    return _ticks(np.column_stack([poses, np.concatenate([asked, asked[-1:]])]), dt)


def _ticks(states: Array, dt: float) -> Tick:
    """T ticks, of x, y, θ, way and turn before each and after the last : (T + 1, …, 5)

    Arcs, by the mid-point rule.
    """
    pose, distance, turn = states[:-1, ..., :3], states[..., 3], states[..., 4]
    middle = states[..., 2] + turn / 2
    steps = distance[..., None] * np.stack([np.cos(middle), np.sin(middle)], axis=-1)
    after = np.concatenate(
        [pose[..., :2] + steps[:-1], wrap(pose[..., 2] + turn[:-1])[..., None]], axis=-1
    )
    return Tick(pose, after, distance[:-1], turn[:-1], steps[:-1] / dt, steps[1:] / dt, dt)
