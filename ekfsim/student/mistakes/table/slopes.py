"""Mistakes of J_x and J_u, the Jacobians of a motion."""

from collections.abc import Callable, Sequence

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.moves import exchanged, southward, towards
from ekfsim.student.mistakes.table.steps import move_turn, moves
from ekfsim.student.mistakes.working import Piece, Pieces, Working


def _moved(s: Working, _: Callable[[], Array]) -> Array:
    return s.f


def bent(by: float, entries: Sequence[int] = (0, 1)) -> Piece:
    """J_x with these rows (of x and y) of its column of θ times `by`."""

    def F(s: Working, right: Callable[[], Array]) -> Array:
        J, θ = np.array(right()), s.places[2]
        J[[s.places[i] for i in entries], θ] *= by
        return J

    return F


def _exchanged_column(of_x: float, of_y: float) -> Piece:
    """J_x with ∂x/∂θ and ∂y/∂θ exchanged, each times its sign."""

    def F(s: Working, right: Callable[[], Array]) -> Array:
        J, (x, y, θ) = np.array(right()), s.places
        J[x, θ], J[y, θ] = of_x * J[y, θ], of_y * J[x, θ]
        return J

    return F


def _of_unit_way(s: Working, right: Callable[[], Array]) -> Array:
    """∂x/∂θ = −sin θ, ∂y/∂θ = cos θ"""
    J, θ = right().copy(), s.x_F[2]
    J[0, 2], J[1, 2] = -np.sin(θ), np.cos(θ)
    return J


def _column(by: float, column: int) -> Piece:
    """J_u with the column of d (0) or a (1) times `by`."""
    return lambda s, right: right() * np.where(np.arange(2) == column, by, 1.0)


def _across(s: Working, _: Callable[[], Array]) -> Array:
    """∂/∂d = (−sin θ, cos θ, 0)"""
    θ = s.x_G[2]
    return np.array([[-np.sin(θ), 0.0], [np.cos(θ), 0.0], [0.0, 1.0]])


def _at(direction: Callable[[float, float], float]) -> Pieces:
    """Both Jacobians at another heading."""
    return {"x_F": towards(direction), "x_G": towards(direction)}


OF_SLOPES = (
    Mistake(
        "J_x-after-move",
        "your P is the one with J_x taken after the move",
        "eq 6: J_x is taken at the estimate before the move",
        moves,
        ({"x_F": _moved},),
    ),
    Mistake(
        "J_u-after-move",
        "your P is the one with J_u taken after the move",
        "eq 6: J_u is taken at the estimate before the move",
        moves,
        ({"x_G": _moved},),
    ),
    Mistake(
        "Jacobians-after-move",
        "your P is the one with J_x and J_u taken after the move",
        "eq 6: the Jacobians are taken at the estimate before the move",
        moves,
        ({"x_F": _moved, "x_G": _moved},),
    ),
    Mistake(
        "J_x-sign-x",
        "your P is the one with the other sign of ∂x/∂θ in J_x",
        "eq 6: J_x, the derivative of the line of x in Φ by θ",
        moves,
        ({"F": bent(-1.0, [0])},),
    ),
    Mistake(
        "J_x-sign-y",
        "your P is the one with the other sign of ∂y/∂θ in J_x",
        "eq 6: J_x, the derivative of the line of y in Φ by θ",
        moves,
        ({"F": bent(-1.0, [1])},),
    ),
    Mistake(
        "J_x-signs",
        "your P is the one with the other sign of both ∂x/∂θ and ∂y/∂θ in J_x",
        "eq 6: J_x, the derivatives of Φ by θ",
        moves,
        ({"F": bent(-1.0)},),
    ),
    Mistake(
        "J_x-identity",
        "your P is the one with J_x = I: the heading's uncertainty does not bend the way",
        "eq 6: J_x, the derivatives of Φ by θ",
        moves,
        ({"F": bent(0.0)}, {"spread": lambda s, _: s.P}),
    ),
    Mistake(
        "J_x-exchanged",
        "your P is the one with sine and cosine exchanged in J_x: ∂x/∂θ and ∂y/∂θ",
        "eq 6: J_x, the derivatives of the lines of x and y in Φ by θ",
        moves,
        tuple({"F": _exchanged_column(*signs)} for signs in ((-1, -1), (1, 1), (1, -1))),
    ),
    Mistake(
        "J_x-without-d",
        "your P is the one with ∂x/∂θ and ∂y/∂θ without the way d in J_x",
        "eq 6: ∂x/∂θ = −d sin θ, ∂y/∂θ = d cos θ",
        move_turn,
        ({"F": _of_unit_way},),
    ),
    Mistake(
        "J_x-without-ones",
        "your P is the one with a J_x that has no ones on its diagonal",
        "eq 6: ∂x/∂x = ∂y/∂y = ∂θ/∂θ = 1",
        moves,
        ({"F": lambda s, right: right() - np.eye(len(s.x))},),
    ),
    Mistake(
        "J_x-transposed",
        "your P is the one with J_x' P J_x",
        "eq 7: J_x P J_x'",
        moves,
        ({"spread": lambda s, _: s.F.T @ s.P @ s.F},),
    ),
    Mistake(
        "J_x-untransposed",
        "your P is the one with J_x P J_x, the second not transposed",
        "eq 7: J_x P J_x'",
        moves,
        ({"spread": lambda s, _: s.F @ s.P @ s.F},),
    ),
    Mistake(
        "J_x-one-sided",
        "your P is the one with J_x on one side of P alone: J_x P or P J_x'",
        "eq 7: J_x P J_x'",
        moves,
        ({"spread": lambda s, _: s.F @ s.P}, {"spread": lambda s, _: s.P @ s.F.T}),
    ),
    Mistake(
        "J_x-elementwise",
        "your P is the one with J_x * P * J_x', entry by entry and not as matrices",
        "eq 7: J_x P J_x' is a product of matrices (in NumPy @, in MATLAB * and not .*)",
        moves,
        ({"spread": lambda s, _: s.F * s.P * s.F.T},),
    ),
    Mistake(
        "J_u-exchanged",
        "your P is the one with sine and cosine exchanged in J_u",
        "eq 6: ∂x/∂d = cos θ, ∂y/∂d = sin θ",
        move_turn,
        ({"G": exchanged},),
    ),
    Mistake(
        "J_u-across",
        "your P is the one whose J_u has ∂x/∂d = −sin θ, ∂y/∂d = cos θ",
        "eq 6: ∂x/∂d = cos θ, ∂y/∂d = sin θ",
        move_turn,
        ({"G": _across},),
    ),
    Mistake(
        "J_u-sign",
        "your P is the one with the other sign of ∂y/∂d in J_u",
        "eq 6: ∂x/∂d = cos θ, ∂y/∂d = sin θ",
        move_turn,
        ({"G": southward},),
    ),
    Mistake(
        "J_u-without-turn",
        "your P is the one without ∂θ/∂a in J_u: a turn adds no uncertainty of the heading",
        "eq 6: ∂θ/∂a = 1",
        move_turn,
        ({"G": _column(0.0, 1)},),
    ),
    Mistake(
        "J_u-without-way",
        "your P is the one without ∂x/∂d and ∂y/∂d in J_u: a way adds no uncertainty of its own",
        "eq 6: ∂x/∂d = cos θ, ∂y/∂d = sin θ",
        move_turn,
        ({"G": _column(0.0, 0)},),
    ),
    Mistake(
        "Jacobians-at-the-turn",
        "your P is the one with the turn a in place of the heading θ in J_x and J_u",
        "eq 6: the Jacobians are taken at θ, the heading before the move",
        move_turn,
        (_at(lambda _, a: a),),
    ),
    Mistake(
        "degrees-in-Jacobians",
        "your P is the one with θ in degrees in the sines and cosines of J_x and J_u",
        "eq 6: ∂x/∂θ = −d sin θ, ∂y/∂θ = d cos θ, θ in radians",
        move_turn,
        (_at(lambda θ, _: np.degrees(θ)),),
    ),
)
