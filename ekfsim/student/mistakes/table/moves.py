"""Mistakes of the mean that a motion leads to, and of the input that it is predicted with."""

from collections.abc import Callable

import numpy as np

from ekfsim.commands import Move
from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.steps import commanded, everywhere, move_turn, moves
from ekfsim.student.mistakes.working import Piece, Pieces, Working

Direction = Callable[[float, float], float]  # of the way, from θ and a


def command(s: Working, _: Callable[[], Array]) -> Array:
    """u as it was asked of the robot."""
    asked = s.asked.command
    assert isinstance(asked, Move)
    return np.array([asked.distance, asked.angle])


def angle(of: Callable[[float], float]) -> Piece:
    """u with another angle."""
    return lambda s, right: np.array([right()[0], of(right()[1])])


def towards(direction: Direction) -> Piece:
    """x with another heading, to take a Jacobian at."""
    return lambda s, _: np.array([s.x[0], s.x[1], direction(s.x[2], s.u_f[1])])


def _driven(direction: Direction) -> Piece:
    """f with the way in another direction."""

    def f(s: Working, _: Callable[[], Array]) -> Array:
        d, a = s.u_f
        along = direction(s.x[2], a)
        return np.array([s.x[0] + d * np.cos(along), s.x[1] + d * np.sin(along), s.x[2] + a])

    return f


def _bent(share: float) -> Piece:
    """J_u where this share of the turn bends the way."""

    def G(s: Working, right: Callable[[], Array]) -> Array:
        d, a = s.u_J
        θ, J = s.x[2] + share * a, right().copy()
        J[0], J[1] = [np.cos(θ), -share * d * np.sin(θ)], [np.sin(θ), share * d * np.cos(θ)]
        return J

    return G


def _along(direction: Direction) -> tuple[Pieces, ...]:
    """The way in another direction; and with the Jacobians taken there as well."""
    f, x = _driven(direction), towards(direction)
    return {"f": f}, {"f": f, "x_F": x, "x_G": x}


def _turning(share: float) -> tuple[Pieces, ...]:
    """The way along a heading that has a share of the turn already; and with its own Jacobians."""

    def direction(θ: float, a: float) -> float:
        return θ + share * a

    f, x = _driven(direction), towards(direction)
    return *_along(direction), {"f": f, "x_F": x, "G": _bent(share)}


def _entry(i: int, of: Callable[[float, float], float]) -> Piece:
    """f with another x, y or θ, from what it was and what it should become."""

    def f(s: Working, right: Callable[[], Array]) -> Array:
        after = right().copy()
        after[s.places[i]] = of(s.x[s.places[i]], after[s.places[i]])
        return after

    return f


def _exchanged_slope(s: Working, right: Callable[[], Array]) -> Array:
    """J_x of an f with sine and cosine exchanged."""
    J, (d, _), θ = right().copy(), s.u_J, s.x[2]
    J[0, 2], J[1, 2] = d * np.cos(θ), -d * np.sin(θ)
    return J


def exchanged(_: Working, right: Callable[[], Array]) -> Array:
    """A Jacobian with its rows of x and y exchanged: sine for cosine."""
    return right()[[1, 0, 2]]


_SINE_FIRST: Piece = _driven(lambda θ, _: np.pi / 2 - θ)
_SOUTH: Piece = _entry(1, lambda before, after: 2 * before - after)


def _southward_slope(_: Working, right: Callable[[], Array]) -> Array:
    """J_x of an f with y − d sin θ."""
    J = right().copy()
    J[1, 2] *= -1
    return J


def southward(_: Working, right: Callable[[], Array]) -> Array:
    """J_u with the other sign in its row of y: ∂y/∂d = −sin θ."""
    J = right().copy()
    J[1] *= -1
    return J


def _half_turns(s: Working, right: Callable[[], Array]) -> Array:
    after, θ = np.array(right()), s.places[2]
    after[θ] %= np.pi
    return after


OF_MOVES = (
    Mistake(
        "turn-before-move",
        "your step turns first, and drives along the new heading",
        "eq 3: first the way d along θ, then the turn a",
        move_turn,
        _turning(1.0),
    ),
    Mistake(
        "command-for-odometry",
        "your step is the one with the commanded motion in place of the measured one",
        "eq 4: u is what the odometry measured; the command is not used at all",
        commanded,
        ({"u": command}, {"u_f": command}, {"u_f": command, "u_J": command}),
    ),
    Mistake(
        "degrees-in-f",
        "your turn a is added in degrees to θ in radians, or the new θ is in degrees",
        "eq 3: θ + a, both in radians",
        move_turn,
        (
            {"u_f": angle(np.degrees)},
            {"u": angle(np.degrees)},
            {"f": _entry(2, lambda _, after: np.degrees(after))},
        ),
    ),
    Mistake(
        "radians-twice",
        "your turn a is taken from degrees to radians, but it is in radians already",
        "eq 3: θ + a, both in radians",
        move_turn,
        ({"u": angle(np.radians)}, {"u_f": angle(np.radians)}, {"u_M": angle(np.radians)}),
    ),
    Mistake(
        "degrees-in-cosine",
        "your cosine and sine are given θ in degrees",
        "eq 3: d cos θ and d sin θ, θ in radians",
        move_turn,
        _along(lambda θ, _: np.degrees(θ)),
    ),
    Mistake(
        "heading-radians-twice",
        "your θ is taken from degrees to radians in cosine and sine, but it is in radians already",
        "eq 3: d cos θ and d sin θ, θ in radians",
        move_turn,
        _along(lambda θ, _: np.radians(θ)),
    ),
    Mistake(
        "middle-heading",
        "your way goes along the heading in the middle of the turn, θ + a/2",
        "eq 3: first the way d along θ, then the turn a",
        move_turn,
        _turning(0.5),
    ),
    Mistake(
        "turn-for-heading",
        "your way goes in the direction a of the turn, not along the heading θ",
        "eq 3: d cos θ and d sin θ",
        move_turn,
        _along(lambda _, a: a),
    ),
    Mistake(
        "sine-for-cosine",
        "your sine and cosine are exchanged in f: x + d sin θ, y + d cos θ",
        "eq 3: x + d cos θ, y + d sin θ",
        move_turn,
        (
            {"f": _SINE_FIRST},
            {"f": _SINE_FIRST, "F": _exchanged_slope, "G": exchanged},
        ),
    ),
    Mistake(
        "y-sign",
        "your y moves the wrong way: y − d sin θ in place of y + d sin θ",
        "eq 3: y + d sin θ",
        move_turn,
        ({"f": _SOUTH}, {"f": _SOUTH, "F": _southward_slope, "G": southward}),
    ),
    Mistake(
        "turn-sign",
        "your θ turns the other way round, θ − a in place of θ + a",
        "eq 3: the line of θ in Φ, which adds the turn",
        moves,
        ({"f": _entry(2, lambda before, after: 2 * before - after)},),
    ),
    Mistake(
        "turn-forgotten",
        "your θ stays as it was: the turn is not added",
        "eq 3: the line of θ in Φ, which adds the turn",
        moves,
        ({"f": _entry(2, lambda before, _: before)},),
    ),
    Mistake(
        "heading-modulo-pi",
        "your θ is brought into [0, π), and so turned round where it is negative",
        "eqs 3, 10: θ may be any angle; a whole turn, 2π, may be taken off it, half a one may not",
        everywhere,
        ({"mean": _half_turns},),
    ),
    Mistake(
        "not-moved",
        "your x stays as it was before the move; only P changes",
        "eq 4: the new estimate is Φ of the old one and of u",
        moves,
        ({"mean": lambda s, _: s.x},),
    ),
)
