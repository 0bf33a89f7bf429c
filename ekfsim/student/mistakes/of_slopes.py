"""Mistakes of J_x and J_u, the Jacobians of a motion."""

from collections.abc import Callable, Sequence

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.of_moves import moves
from ekfsim.student.mistakes.working import Piece, Working


def _moved(s: Working, _: Callable[[], Array]) -> Array:
    return s.f


def _bent(by: float, entries: Sequence[int]) -> Piece:
    """J_x with these rows (of x and y) of its column of θ times `by`."""

    def F(s: Working, right: Callable[[], Array]) -> Array:
        J, θ = np.array(right()), s.places[2]
        J[[s.places[i] for i in entries], θ] *= by
        return J

    return F


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
        "eq 6: ∂x/∂θ = −d sin θ",
        moves,
        ({"F": _bent(-1.0, [0])},),
    ),
    Mistake(
        "J_x-sign-y",
        "your P is the one with the other sign of ∂y/∂θ in J_x",
        "eq 6: ∂y/∂θ = d cos θ",
        moves,
        ({"F": _bent(-1.0, [1])},),
    ),
    Mistake(
        "J_x-signs",
        "your P is the one with the other sign of both ∂x/∂θ and ∂y/∂θ in J_x",
        "eq 6: ∂x/∂θ = −d sin θ, ∂y/∂θ = d cos θ",
        moves,
        ({"F": _bent(-1.0, [0, 1])},),
    ),
)
