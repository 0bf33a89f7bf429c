"""Mistakes of the mean that a motion leads to, and of the input that it is predicted with."""

from collections.abc import Callable

import numpy as np

from ekfsim.commands import Move
from ekfsim.geometry import Array
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.records import Control
from ekfsim.student.asked import Asked
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.working import Piece, Pieces, Working


def moves(asked: Asked) -> bool:
    """A motion of any robot."""
    return isinstance(asked.given, Control)


def move_turn(asked: Asked) -> bool:
    """A move of the classroom's robot."""
    return isinstance(asked.given, Control) and isinstance(asked.given.motion, MoveTurn)


def commanded(asked: Asked) -> bool:
    """A move of the classroom's robot, whose command is known."""
    return move_turn(asked) and isinstance(asked.command, Move)


def _command(s: Working, _: Callable[[], Array]) -> Array:
    command = s.asked.command
    assert isinstance(command, Move)
    return np.array([command.distance, command.angle])


def _turned(share: float) -> Piece:
    """x with this share of the turn in its heading already."""

    def x(s: Working, _: Callable[[], Array]) -> Array:
        return np.array([s.x[0], s.x[1], s.x[2] + share * s.u_f[1]])

    return x


def _driven(share: float) -> Piece:
    """f with the way along a heading that has this share of the turn."""

    def f(s: Working, _: Callable[[], Array]) -> Array:
        d, a = s.u_f
        θ = s.x[2] + share * a
        return np.array([s.x[0] + d * np.cos(θ), s.x[1] + d * np.sin(θ), s.x[2] + a])

    return f


def _bent(share: float) -> Piece:
    """J_u of that f: now the turn bends the way."""

    def G(s: Working, right: Callable[[], Array]) -> Array:
        d, a = s.u_J
        θ, J = s.x[2] + share * a, right().copy()
        J[0], J[1] = [np.cos(θ), -share * d * np.sin(θ)], [np.sin(θ), share * d * np.cos(θ)]
        return J

    return G


def _along(share: float) -> tuple[Pieces, ...]:
    f, x = _driven(share), _turned(share)
    return {"f": f}, {"f": f, "x_F": x, "x_G": x}, {"f": f, "x_F": x, "G": _bent(share)}


def _angle(of: Callable[[Array], Array]) -> Piece:
    """The input with another angle."""
    return lambda s, right: np.array([right()[0], of(right()[1])])


OF_MOVES = (
    Mistake(
        "turn-before-move",
        "your step turns first and drives along the new heading",
        "eq 3: first the way d along θ, then the turn a",
        move_turn,
        _along(1.0),
    ),
    Mistake(
        "command-for-odometry",
        "your step is the one with the commanded motion in place of the measured one",
        "eq 4: u is what the odometry measured; the command is not used at all",
        commanded,
        ({"u": _command}, {"u_f": _command}, {"u_f": _command, "u_J": _command}),
    ),
    Mistake(
        "degrees-in-f",
        "your angle a is in degrees where radians are added to θ",
        "eq 3: a is in radians, as θ is",
        move_turn,
        ({"u_f": _angle(np.degrees)}, {"u": _angle(np.degrees)}),
    ),
    Mistake(
        "middle-heading",
        "your way goes along the heading in the middle of the turn, θ + a/2",
        "eq 3: first the way d along θ, then the turn a",
        move_turn,
        _along(0.5),
    ),
)
