"""Mistakes of h: along which beam, to which wall; and the pose that it is taken at."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ekfsim.geometry import Array, Booleans
from ekfsim.raycast.walls import BOUNDARY
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.steps import after_a_move, after_a_reading, beams
from ekfsim.student.mistakes.working import Piece, Pieces, Working

AT_AN_END = 1e-9  # of a wall's length: a crossing that is this near to its end is on the wall
PARALLEL = 1e-9


class Crossed(NamedTuple):
    """Where a beam's line crosses the lines of all walls. Arrays are (W,)."""

    r: Array  # m ahead of the robot, below 0 behind it
    on: Booleans  # whether the wall reaches as far as there
    aside: Array  # m, the distance of the robot from the wall's line
    boundary: Booleans  # whether the wall is the room's own

    def first(self, among: Booleans) -> int:
        """The nearest of these."""
        return int(np.argmin(np.where(among, self.r, np.inf)))


Heading = Callable[[float, float], float]  # of the beam, from θ and the bearing
Choice = Callable[[Crossed, Working], int]  # of the wall that is met
Length = Callable[[float], float]  # what is made of its distance


class Seen(NamedTuple):
    """What a beam meets as a student has it."""

    r: float  # m
    slope: Array  # ∂r/∂x : (3,)


def _straight(θ: float, bearing: float) -> float:
    return θ + bearing


def _first_wall(crossed: Crossed, _: Working) -> int:
    return crossed.first(crossed.on & (crossed.r >= 0))


def _look(s: Working, x: Array, heading: Heading, choice: Choice, length: Length) -> Seen:
    """Follow a beam from x as textbooks do: the lines of all walls, and one of the crossings."""
    seen: Seen = s.model.once(
        (heading, choice, length, x.tobytes(), s.z.tobytes()),
        lambda: _follow(s, x, heading, choice, length),
    )
    return seen


def _follow(s: Working, x: Array, heading: Heading, choice: Choice, length: Length) -> Seen:
    walls = s.laser.walls  # the straight ones
    if not len(walls.segments):
        return Seen(np.nan, np.zeros(3))
    a, b = walls.segments[:, 0], walls.segments[:, 1]
    along = heading(x[2], s.laser.bearing)
    d = np.array([np.cos(along), np.sin(along)])
    n_d, n_a = walls.normals @ d, np.vecdot(walls.normals, a - x[:2])
    met = np.abs(n_d) > PARALLEL
    r = np.where(met, n_a / np.where(met, n_d, 1.0), np.nan)
    share = np.vecdot(x[:2] + r[:, None] * d - a, b - a) / np.vecdot(b - a, b - a)
    on = (share >= -AT_AN_END) & (share <= 1 + AT_AN_END)
    is_boundary = np.array([name == BOUNDARY for name in walls.names])[walls.polygon[: len(a)]]
    i = choice(Crossed(r, on, np.abs(n_a), is_boundary), s)
    n, far = walls.normals[i], length(float(r[i]))
    turned = far * (n @ np.array([-d[1], d[0]]))
    return Seen(far, -np.array([n[0], n[1], turned]) / n_d[i])


def ways_to(
    heading: Heading = _straight, choice: Choice = _first_wall, length: Length = float
) -> tuple[Pieces, ...]:
    """Ways to look at another wall: h and all that follows from it; h with J_H or with C_v from it;
    h alone.
    """
    h: Piece = lambda s, _: np.array([_look(s, s.x_h, heading, choice, length).r])  # noqa: E731
    H: Piece = lambda s, _: _look(s, s.x_H, heading, choice, length).slope[None]  # noqa: E731
    R: Piece = lambda s, _: np.diag((s.laser.range_ratio * s.h) ** 2)  # noqa: E731
    return {"h": h, "H": H, "R": R}, {"h": h}, {"h": h, "H": H}, {"h": h, "R": R}


def _far(crossed: Crossed, _: Working) -> int:
    return int(np.argmax(np.where(crossed.on & (crossed.r >= 0), crossed.r, -np.inf)))


def _listed_first(crossed: Crossed, _: Working) -> int:
    return int(np.argmax(crossed.on & (crossed.r >= 0)))


def _listed_last(crossed: Crossed, _: Working) -> int:
    return len(crossed.r) - 1 - int(np.argmax((crossed.on & (crossed.r >= 0))[::-1]))


def _either_way(crossed: Crossed, _: Working) -> int:
    return int(np.argmin(np.where(crossed.on, np.abs(crossed.r), np.inf)))


def _rearmost(crossed: Crossed, _: Working) -> int:
    return crossed.first(crossed.on)


def _nearest_line(crossed: Crossed, _: Working) -> int:
    return int(np.argmin(np.where(crossed.r >= 0, crossed.aside, np.inf)))


def _likeliest(crossed: Crossed, s: Working) -> int:
    there = crossed.on & (crossed.r >= 0)
    return int(np.argmin(np.where(there, np.abs(crossed.r - s.z[0]), np.inf)))


def _upright(s: Working, right: Callable[[], Array]) -> Array:
    """The shortest way to the wall, r cos of the angle to its normal: 1/cos is |∂r/∂p|."""
    shortest: Array = right() / np.hypot(*s.model.H(s.x_h)[0, :2])
    return shortest


def _earlier(s: Working, _: Callable[[], Array]) -> Array:
    """The estimate before the call before."""
    assert s.asked.earlier is not None
    return s.asked.earlier.x


def _of_the_batch(s: Working, _: Callable[[], Array]) -> Array:
    """The estimate before the first of the readings that follow one another."""
    asked = s.asked
    while asked.earlier is not None and after_a_reading(asked):
        asked = asked.earlier
    return asked.x


def _stale(x: Piece) -> tuple[Pieces, ...]:
    return {"x_h": x, "x_H": x, "x_R": x}, {"x_h": x, "x_R": x}, {"x_h": x}, {"x_h": x, "x_H": x}


OF_BEAMS = (
    Mistake(
        "endless-walls",
        "your walls are endless lines: your beam meets one where no wall is",
        "eq 8: h is the distance to the first wall; a wall ends at its two points",
        beams,
        ways_to(choice=lambda crossed, _: crossed.first(crossed.r >= 0)),
    ),
    Mistake(
        "bearing-forgotten",
        "your beam looks straight ahead, whatever the angle of the sense command",
        "eq 8: the beam's direction is θ plus the angle at which it is sensed",
        beams,
        ways_to(lambda θ, _: θ),
    ),
    Mistake(
        "heading-forgotten",
        "your beam looks along the angle of the sense command, without the heading θ",
        "eq 8: the beam's direction is θ plus the angle at which it is sensed",
        beams,
        ways_to(lambda _, bearing: bearing),
    ),
    Mistake(
        "bearing-sign",
        "your beam looks to the other side: θ minus the angle of the sense command",
        "eq 8: the beam's direction is θ plus the angle at which it is sensed",
        beams,
        ways_to(lambda θ, bearing: θ - bearing),
    ),
    Mistake(
        "degrees-in-bearing",
        "your angle of the sense command is in degrees where θ in radians is added",
        "eq 8: the beam's direction is θ plus the angle, both in radians",
        beams,
        ways_to(lambda θ, bearing: θ + np.degrees(bearing)),
    ),
    Mistake(
        "bearing-radians-twice",
        "your beam's angle is taken from degrees to radians, but it is in radians already",
        "eq 8: the beam's direction is θ plus the angle, both in radians",
        beams,
        (
            *ways_to(lambda θ, bearing: θ + np.radians(bearing)),
            *ways_to(lambda θ, bearing: np.radians(θ + bearing)),
        ),
    ),
    Mistake(
        "degrees-in-beam",
        "your cosine and sine of the beam's direction are given degrees",
        "eq 8: the beam's direction is θ plus the angle, both in radians",
        beams,
        ways_to(lambda θ, bearing: np.degrees(θ + bearing)),
    ),
    Mistake(
        "obstacles-ignored",
        "your beam goes through the obstacles, to the room's own wall",
        "eq 8: h is the distance to the first wall, be it the room's or an obstacle's",
        beams,
        ways_to(choice=lambda c, _: c.first(c.on & (c.r >= 0) & c.boundary)),
    ),
    Mistake(
        "far-wall",
        "your beam goes on to the last wall on its way",
        "eq 8: h is the distance to the first wall",
        beams,
        ways_to(choice=_far),
    ),
    Mistake(
        "wall-of-the-list",
        "your beam takes the last or the first wall of your list that it crosses, not the nearest",
        "eq 8: h is the distance to the first wall on the beam's way",
        beams,
        (*ways_to(choice=_listed_last), *ways_to(choice=_listed_first)),
    ),
    Mistake(
        "wall-behind",
        "your beam looks backwards as well: it meets a wall behind the robot",
        "eq 8: h is the distance to the first wall ahead of the beam",
        beams,
        (
            *ways_to(choice=_either_way)[:1],
            *ways_to(choice=_rearmost)[:1],
            *ways_to(choice=_either_way, length=abs),
            *ways_to(choice=_either_way)[1:],
            *ways_to(choice=_rearmost)[1:],
        ),
    ),
    Mistake(
        "nearest-line",
        "your beam takes the wall whose line is nearest to the robot, not the one it meets first",
        "eq 8: h is the distance along the beam, to the first wall",
        beams,
        ways_to(choice=_nearest_line),
    ),
    Mistake(
        "wall-by-reading",
        "your wall is the one whose distance is nearest to the reading, not the one that h meets",
        "eq 8: h is the distance to the first wall; it is predicted without the reading",
        beams,
        ways_to(choice=_likeliest),
    ),
    Mistake(
        "shortest-distance",
        "your h is the shortest distance to the wall, not that along the beam",
        "eq 8: h is the distance along the beam",
        beams,
        (
            {"h": _upright, "R": lambda s, _: np.diag((s.laser.range_ratio * s.h) ** 2)},
            {"h": _upright},
        ),
    ),
    Mistake(
        "stale-estimate",
        "your h, or h and J_H, are of the estimate before an earlier reading of this place",
        "eqs 8, 11: h and J_H are taken at the newest estimate",
        after_a_reading,
        (*_stale(_of_the_batch), *_stale(_earlier)),
    ),
    Mistake(
        "stale-J_H",
        "your J_H is that of the estimate before an earlier reading of this place",
        "eq 11: J_H is taken at the newest estimate",
        after_a_reading,
        ({"x_H": _of_the_batch}, {"x_H": _earlier}),
    ),
    Mistake(
        "estimate-before-move",
        "your h, or h and J_H, are of the estimate before the move",
        "eqs 8, 11: h and J_H are taken at the newest estimate, after the move",
        after_a_move,
        _stale(_earlier),
    ),
    Mistake(
        "J_H-before-move",
        "your J_H is that of the estimate before the move",
        "eq 11: J_H is taken at the newest estimate, after the move",
        after_a_move,
        ({"x_H": _earlier},),
    ),
)
