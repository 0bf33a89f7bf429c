"""Mistakes of P_u, and of what is made of P by a motion."""

from collections.abc import Callable

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.of_moves import move_turn, moves
from ekfsim.student.mistakes.working import Working


def _deviations(_: Working, right: Callable[[], Array]) -> Array:
    """σ where σ² belongs."""
    return np.diag(np.sqrt(np.diag(right())))


OF_NOISE = (
    Mistake(
        "sigma-in-P_u",
        "your P_u holds σ where σ² belongs",
        "eq 1: the diagonal of P_u holds variances, σ_d² and σ_a²",
        moves,
        ({"M": _deviations},),
    ),
    Mistake(
        "noise-without-J_u",
        "your P is the one with P_u added as it is, without J_u on its sides",
        "eq 7: J_u P_u J_u'",
        move_turn,
        (
            {"noise": lambda s, _: np.diag([s.M[0, 0], 0.0, s.M[1, 1]])},
            {"noise": lambda s, _: np.diag([s.M[0, 0], s.M[0, 0], s.M[1, 1]])},
        ),
    ),
)
