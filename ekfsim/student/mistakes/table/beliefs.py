"""Mistakes of the belief that a step begins with, and of whether it is revised at all."""

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.steps import after_a_move, everywhere, first, readings
from ekfsim.student.mistakes.working import Piece, Working


def _earlier(s: Working) -> Gaussian:
    earlier = s.asked.earlier
    assert earlier is not None
    return Gaussian(earlier.x, earlier.P)


def _times_I(by: float) -> Piece:
    return lambda s, _: by * np.eye(len(s.x))


BELIEF_KEPT = Mistake(
    "reading-refused",
    "your step leaves the belief as it was: there is no update, or a gate refuses good readings",
    "eqs 10, 12: x + K r and (I − K J_H) P; a gate refuses r² / S beyond a high quantile",
    readings,
    ({"mean": lambda s, _: s.x, "covariance": lambda s, _: s.P},),
)
OWN_FIRST_P = Mistake(
    "own-first-P",
    "your run begins with a P of its own, not with the one that it is given",
    "eq 2: at the start P is what is given: 0 where the start is known exactly",
    first,
    tuple({"P": _times_I(by)} for by in (1.0, 0.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 10.0, 1e2, 1e3)),
)
OWN_FIRST_X = Mistake(
    "own-first-x",
    "your run begins at an x of its own, not at the start that it is given",
    "eq 4: the first estimate is the given start",
    first,
    ({"x": lambda s, _: np.zeros_like(s.asked.x)},),
)
OF_BELIEFS = (
    BELIEF_KEPT,
    Mistake(
        "P-before-move",
        "your update is the one with the P of before the move: the predicted P is not used",
        "eqs 11, 12: P is that of eq 7",
        after_a_move,
        ({"P": lambda s, _: _earlier(s).covariance},),
    ),
    Mistake(
        "x-before-move",
        "your update is the one with the x of before the move, or with the x and P of before it",
        "eqs 8, 10: x is that of eq 4",
        after_a_move,
        (
            {"x": lambda s, _: _earlier(s).mean},
            {"x": lambda s, _: _earlier(s).mean, "P": lambda s, _: _earlier(s).covariance},
        ),
    ),
    Mistake(
        "P-is-zero",
        "your P is 0: your filter is certain of everything",
        "eqs 7, 12: P grows with every move, and no reading makes all of it 0",
        everywhere,
        ({"covariance": lambda s, _: np.zeros((len(s.x), len(s.x)))},),
    ),
    OWN_FIRST_P,
    OWN_FIRST_X,
)
